// Joints that go along with the surface round them.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Where joints are once the surface has moved: each by the affine map that takes the surface near it nearest to where
// it is now. A vertex counts by its area over the fourth power of its distance, as far as it hangs on the joint, on the
// one above it or on one right below; where too little of it lies round the joint to tell an affine map, the map is
// nearer to a shift.
//
// before   the surface as `places` (#J) lie in it
// after    #V, where its vertices are now
// weights  of the surface's vertices over the skeleton's joints
// Joints that no vertex hangs on move as the joint above does; roots then stay.
// Cost: O(#V slots + #J).
std::vector<Vec3> followSurface(const Skeleton& skeleton, std::span<const Vec3> positions, const TriMesh& before,
                                std::span<const Vec3> after, const SkinWeights& weights);

}  // namespace limber
