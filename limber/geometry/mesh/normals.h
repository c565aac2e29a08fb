// Normals of vertices from the triangles round them.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// #V vectors, pointing as the triangles' corners run counter-clockwise: the sum of the triangles' unit normals, each
// times twice its area; zero where a vertex has no triangle. Positions in any precision, the sums in double. Cost: O(#V
// + #F).
template <typename Position>
std::vector<Vec3> areaNormals(std::span<const Position> positions, std::span<const Triangle> triangles) {
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  for (const Triangle& t : triangles) {
    const Vec3 a = positions[t[0]].template cast<double>();
    const Vec3 b = positions[t[1]].template cast<double>();
    const Vec3 c = positions[t[2]].template cast<double>();
    const Vec3 normal = (b - a).cross(c - a);
    for (const Index v : t) normals[v] += normal;
  }
  return normals;
}

}  // namespace limber
