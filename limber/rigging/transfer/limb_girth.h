// How thick the limbs of a body are round its bones, against those of another one.
#pragma once

#include <span>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/transfer/limb_alignment.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Grows and shrinks what each joint carries until it is as thick as the target is round the same bone: across a bone
// that leads to the next joint; all round the last joint of a limb and where bones part, so that a head fits one three
// times its size. By rays from the bone through the source's vertices: the median of how much later they leave the
// target than the source, 1/6 to 6. Joints of which fewer than half of the rays meet the target stay as they are.
//
// source     at rest, as `globals` and `weights` (of its vertices) are
// landmarks  those that `alignment` was made with (alignLimbs); joints below the last of them go along
// Both surfaces facing outwards, with triangles. Cost: O(#V log #F), of at most 200 vertices of each joint.
void fitGirths(const Skeleton& skeleton, std::span<const Affine> globals, std::span<const JointLandmark> landmarks,
               const TriMesh& source, const SkinWeights& weights, const TriMesh& target, LimbAlignment& alignment);

}  // namespace limber
