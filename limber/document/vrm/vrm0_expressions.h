// The blend shape groups of VRM 0.x as expressions.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// "blendShapeMaster" of VRM 0.x as "expressions" of VRM 1.0; null where it has none. Colours are taken over as they
// are, as UniVRM and three-vrm do. Warning "vrm0-expressions" where a group changes of a material what 1.0 has no word
// for.
Json expressionsOfVrm0(Asset& asset, const Json& blendShapeMaster);

}  // namespace limber
