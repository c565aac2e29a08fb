#include "limber/geometry/surface/border_lengths.h"

#include <algorithm>

namespace limber {

std::vector<double> borderLengths(std::span<const Vec3f> points, std::span<const Triangle> triangles,
                                  std::span<const VertexPair> edges) {
  std::vector<std::size_t> begins(points.size() + 1, 0);  // of the edges that begin at each vertex
  for (const VertexPair& edge : edges) ++begins[edge[0] + 1];
  for (std::size_t v = 0; v < points.size(); ++v) begins[v + 1] += begins[v];
  std::vector<double> lengths(edges.size(), 0);
  for (const Triangle& triangle : triangles) {
    const Vec3f middle = (points[triangle[0]] + points[triangle[1]] + points[triangle[2]]) / 3;
    for (int corner = 0; corner < 3; ++corner) {
      const auto [first, second] = std::minmax(triangle[corner], triangle[(corner + 1) % 3]);
      std::size_t e = begins[first];
      while (e < begins[first + 1] && edges[e][1] < second) ++e;
      if (e == begins[first + 1] || edges[e][1] != second) continue;  // of a triangle without area
      lengths[e] += (middle - 0.5f * (points[first] + points[second])).norm();
    }
  }
  return lengths;
}

}  // namespace limber
