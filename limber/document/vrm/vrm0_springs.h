// The springs of VRM 0.x as VRMC_springBone.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// "secondaryAnimation" of VRM 0.x as the extension VRMC_springBone; null where it has no spring. In 0.x all that hangs
// on a bone swings: each node with its first child, the last of a chain as if 7 cm followed. Chains part where nodes
// have several children; the 7 cm become nodes of their own. A node that hangs on two such bones swings with the first.
Json springsOfVrm0(Asset& asset, const Json& secondaryAnimation);

}  // namespace limber
