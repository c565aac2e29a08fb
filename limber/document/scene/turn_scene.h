// A whole document turned, with nothing in it changed.
#pragma once

#include <string>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// Puts the content of the scenes below new nodes that rotate it about the world's origin, one for each scene that shows
// something else. A document without scenes gets one. Skinned meshes at a scene's root stay there: only their joints
// position them.
void turnScene(Asset& asset, const Quat& turn, const std::string& name);

}  // namespace limber
