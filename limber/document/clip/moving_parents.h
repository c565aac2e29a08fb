// Movement of the nodes above a skeleton, brought to what it moves.
#pragma once

#include <span>

#include "limber/document/rig/rig_io.h"

namespace limber {

// In the animations with these numbers, nodes above root joints no longer move afterwards: what they moved gets
// channels of its own with the same result. These are the root joints, where clips have that movement already
// (readClips), and whatever else is below such nodes, except skinned meshes, which follow their joints. Sampled as
// readClips does; warnings "moving-parents", and "still-parents" where such a node itself shows a mesh without a skin,
// a camera or a light, which now no longer moves.
//
// For edits that take joints' clips out of a document and put them back: channels of nodes above would move them twice.
// `skeleton` is that of the asset. Throws as readClips and addClips do.
void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton, std::span<const Index> animations);

// The same in all animations.
void settleMovingParents(Asset& asset, const AssetSkeleton& skeleton);

}  // namespace limber
