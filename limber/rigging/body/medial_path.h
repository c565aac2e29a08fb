// Ways through the middle of a body's parts.
#pragma once

#include <vector>

#include "limber/rigging/body/body_volume.h"

namespace limber {

// The centres of medial spheres that lead from the sphere nearest to `from` to the one nearest to `to`, each
// all but touching the next: the shortest such way inside. Empty where there is none. Mesh space. Cost: O(S^2) for S
// spheres.
std::vector<Vec3> medialPath(const BodyVolume& body, const Vec3& from, const Vec3& to);

// The place at a share of the length of a way of at least one place.
Vec3 alongPath(const std::vector<Vec3>& path, double fraction);

}  // namespace limber
