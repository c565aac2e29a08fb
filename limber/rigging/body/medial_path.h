// Paths through the middle of a body's parts.
#pragma once

#include <vector>

#include "limber/rigging/body/body_volume.h"

namespace limber {

// The centres of medial spheres that lead from the sphere nearest to `from` to the one nearest to `to`, each all but
// touching the next: the shortest such path inside. Empty where there is none. Mesh space. Cost: O(S^2) for S spheres.
std::vector<Vec3> medialPath(const BodyVolume& body, const Vec3& from, const Vec3& to);

// The position at `fraction` of the length of `path`, which has one point or more.
Vec3 alongPath(const std::vector<Vec3>& path, double fraction);

}  // namespace limber
