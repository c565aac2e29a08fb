// The winged creature as somebody else would deliver it: with a rig of its own, and flying.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// Bound in the pose of wingedCharacter(); one clip, "fly", of one beat of the wings, its last frame posed as the first.
Asset makeFlying();

}  // namespace limber
