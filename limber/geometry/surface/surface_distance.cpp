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

SurfaceDistance::SurfaceDistance(TriMesh mesh) : mesh_(std::move(mesh)) {
  firstTriangle_.assign(std::size_t{mesh_.vertexCount()} + 1, 0);
  for (const Triangle& triangle : mesh_.triangles) {
    for (const Index v : triangle) ++firstTriangle_[v + 1];
  }
  for (std::size_t v = 1; v < firstTriangle_.size(); ++v) firstTriangle_[v] += firstTriangle_[v - 1];
  triangles_.resize(firstTriangle_.back());
  std::vector<Index> next(firstTriangle_);
  for (Index t = 0; t < mesh_.triangleCount(); ++t) {
    for (const Index v : mesh_.triangles[t]) triangles_[next[v]++] = t;
  }
}

std::pair<const Index*, const Index*> SurfaceDistance::trianglesAt(Index vertex) const {
  return {triangles_.data() + firstTriangle_[vertex], triangles_.data() + firstTriangle_[vertex + 1]};
}

std::vector<Index> SurfaceDistance::neighbours(Index vertex) const {
  std::vector<Index> result;
  const auto [begin, end] = trianglesAt(vertex);
  for (const Index* t = begin; t != end; ++t) {
    for (const Index v : mesh_.triangles[*t]) {
      if (v != vertex) result.push_back(v);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

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
    const auto [begin, end] = trianglesAt(vertex);
    for (const Index* t = begin; t != end; ++t) {
      const Triangle& corners = mesh_.triangles[*t];
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
