// Movement of the nodes above a skeleton, brought to what it moves.
#pragma once

#include <span>

#include "limber/document/rig/rig_io.h"

namespace limber {

// In the animations with these numbers nodes above root joints stand still afterwards: what they moved has channels of
// its own that say the same. These are the root joints, where clips have that movement already (readClips), and
// whatever else hangs on such nodes, but for skinned meshes, which their joints carry. Sampled as readClips does;
// warnings "moving-parents", and "still-parents" where a mesh without a skin, a camera or a light is on such a node
// itself and stands still now.
//
// For edits that take joints' clips out of a document and put them back: channels of nodes above would move them twice.
// `skeleton` is that of the asset. Throws as readClips and addClips do.
void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations);

// The same in all animations.
void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton);

}  // namespace limber
