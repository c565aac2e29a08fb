#include "limber/geometry/surface/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>


namespace limber {

namespace {

// The distance of `c` from a source that is `da` from `a` and `db` from `b`, along a straight path across the edge
// between them, with the triangle unfolded beside the source. Infinite where that path misses the edge.
double acrossEdge(const Vec3& a, double da, const Vec3& b, double db, const Vec3& c) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Vec3 edge = b - a;
  const double length = edge.norm();
  if (!(length > 0)) return kNone;
  // In the plane: a at the origin, b on the x axis, the source below it, c above.
  const double sx = (da * da - db * db + length * length) / (2 * length);
  const double sy = -std::sqrt(std::max(0.0, da * da - sx * sx));
  const double cx = (c - a).dot(edge) / length;
  const double cy = std::sqrt(std::max(0.0, (c - a).squaredNorm() - cx * cx));
  const double rise = cy - sy;
  if (!(rise > 0)) return kNone;
  const double crossing = sx - sy / rise * (cx - sx);
  if (crossing < 0 || crossing > length) return kNone;
  return std::hypot(cx - sx, rise);
}

}  // namespace

SurfaceDistance::SurfaceDistance(TriMesh mesh)
    : mesh_(std::move(mesh)), trianglesAt_(trianglesAtVertices(mesh_.triangles, mesh_.vertexCount())) {}

std::vector<VertexDistance> SurfaceDistance::within(Index triangle, const Vec3& barycentric, double radius) const {
  using Reached = std::pair<double, Index>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  std::unordered_map<Index, double> best;  // looked up alone, never walked
  std::unordered_map<Index, bool> settled;
  const auto reach = [&](Index vertex, double distance) {
    if (distance > radius) return;
    const auto [known, isNew] = best.try_emplace(vertex, distance);
    if (!isNew && !(distance < known->second)) return;
    known->second = distance;
    front.push({distance, vertex});
  };

  Vec3 source = Vec3::Zero();
  for (int k = 0; k < 3; ++k) source += barycentric[k] * mesh_.position(mesh_.triangles[triangle][k]);
  for (const Index v : mesh_.triangles[triangle]) reach(v, (mesh_.position(v) - source).norm());

  std::vector<VertexDistance> result;
  while (!front.empty()) {
    const auto [distance, vertex] = front.top();
    front.pop();
    if (settled[vertex]) continue;
    settled[vertex] = true;
    result.push_back({vertex, distance});
    for (const Index t : trianglesAt_.of(vertex)) {
      const Triangle& corners = mesh_.triangles[t];
      for (int k = 0; k < 3; ++k) {
        const Index far = corners[k], next = corners[(k + 1) % 3];
        const Index other = next == vertex ? corners[(k + 2) % 3] : next;
        if (far == vertex || settled[far]) continue;
        reach(far, distance + (mesh_.position(far) - mesh_.position(vertex)).norm());
        if (!settled[other]) continue;
        reach(far,
              acrossEdge(mesh_.position(vertex), distance, mesh_.position(other), best[other], mesh_.position(far)));
      }
    }
  }
  return result;
}

}  // namespace limber
