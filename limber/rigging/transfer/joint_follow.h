// Joints that go along with the surface round them.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Positions of joints once the surface has moved: each by the affine map that brings the surface near it nearest to its
// new position. A vertex counts by its area over the fourth power of its distance, as far as it is bound to the joint,
// to its parent or to one of its children; where too little of it lies round the joint to determine an affine map, the
// map is nearer to a translation.
//
// before   the surface in which the joints are at `positions` (#J)
// after    #V, where its vertices are now
// weights  of the surface's vertices over the skeleton's joints
// Joints without bound vertices move as their parent does; roots then stay.
// Cost: O(#V slots + #J).
std::vector<Vec3> followSurface(const Skeleton& skeleton, std::span<const Vec3> positions, const TriMesh& before,
                                std::span<const Vec3> after, const SkinWeights& weights);

}  // namespace limber
