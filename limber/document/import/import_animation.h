// Assimp's node animations as glTF's.
#pragma once

#include <map>

#include "limber/core/types.h"
#include "limber/document/asset.h"

struct aiNode;
struct aiScene;

namespace limber {

// Adds one animation for each of the scene's that moves a node of the document. Times in seconds from the animation's
// start, strictly increasing (of keys at one time the last counts); translations multiplied by `scale`; rotations of
// unit length, each on the near side of the one before. Keys before 0 or not finite are left out, with a warning.
void importAnimations(Asset& asset, const aiScene& scene, const std::map<const aiNode*, Index>& nodeOf, double scale);

}  // namespace limber
