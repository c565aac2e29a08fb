#include "limber/geometry/surface/surface_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/edge_groups.h"

namespace limber {

namespace {

// Union-find over triangles that also knows whether a triangle agrees with its root.
class FacingSets {
 public:
  explicit FacingSets(std::size_t count) : parent_(count), turned_(count, 0) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  // The root of t's set; turned(t) is afterwards relative to it.
  Index find(Index t) {
    Index root = t;
    std::uint8_t turned = 0;
    while (parent_[root] != root) {
      turned ^= turned_[root];
      root = parent_[root];
    }
    while (parent_[t] != root && t != root) {
      const Index next = parent_[t];
      const std::uint8_t rest = turned ^ turned_[t];
      parent_[t] = root;
      turned_[t] = turned;
      turned = rest;
      t = next;
    }
    return root;
  }
  bool turned(Index t) const { return turned_[t] != 0; }

  void unite(Index a, Index b, bool disagree) {
    const Index rootA = find(a), rootB = find(b);
    if (rootA == rootB) return;
    const auto [low, high] = std::minmax(rootA, rootB);
    parent_[high] = low;
    turned_[high] = static_cast<std::uint8_t>(disagree ^ turned(a) ^ turned(b));
  }

 private:
  std::vector<Index> parent_;
  std::vector<std::uint8_t> turned_;
};

// What tells in from out for one part of the surface.
struct Part {
  double area = 0, keptArea = 0;  // all; what agrees with the root as stored
  Vec3 center = Vec3::Zero();     // area weighted
  double volume = 0;              // signed, of the cones from the centre, all triangles facing as the root
};

std::vector<std::int8_t> facingOf(const TriMesh& mesh, FacingSets& sets) {
  const Index count = mesh.triangleCount();
  std::vector<Index> rootOf(count);
  std::vector<Index> partOf(count, kNoIndex);  // root -> part
  std::vector<Part> parts;
  const auto corners = [&](Index t) {
    const Triangle& v = mesh.triangles[t];
    return std::array<Vec3, 3>{mesh.position(v[0]), mesh.position(v[1]), mesh.position(v[2])};
  };
  for (Index t = 0; t < count; ++t) {
    rootOf[t] = sets.find(t);
    if (partOf[rootOf[t]] == kNoIndex) {
      partOf[rootOf[t]] = static_cast<Index>(parts.size());
      parts.emplace_back();
    }
    Part& part = parts[partOf[rootOf[t]]];
    const auto [a, b, c] = corners(t);
    const double area = triangleArea(a, b, c);
    part.area += area;
    if (!sets.turned(t)) part.keptArea += area;
    part.center += (area / 3) * (a + b + c);
  }
  for (Part& part : parts) {
    if (part.area > 0) part.center /= part.area;
  }
  for (Index t = 0; t < count; ++t) {
    Part& part = parts[partOf[rootOf[t]]];
    const auto [a, b, c] = corners(t);
    const double cone = (a - part.center).dot((b - part.center).cross(c - part.center)) / 6;
    part.volume += sets.turned(t) ? -cone : cone;
  }
  std::vector<std::int8_t> facing(count);
  for (Index t = 0; t < count; ++t) {
    const Part& part = parts[partOf[rootOf[t]]];
    // A thousandth of the ball of that area: less says nothing about in and out.
    const double noticeable = 1e-3 * std::sqrt(part.area * part.area * part.area / (36 * kPi));
    const bool turnPart = std::abs(part.volume) > noticeable ? part.volume < 0 : 2 * part.keptArea < part.area;
    facing[t] = turnPart != sets.turned(t) ? -1 : 1;
  }
  return facing;
}

}  // namespace

SurfaceEdges surfaceEdges(const TriMesh& mesh) {
  const EdgeGroups groups(mesh.triangles, mesh.vertexCount());
  SurfaceEdges result;
  result.edges.reserve(3 * mesh.triangles.size() / 2 + 1);
  FacingSets sets(mesh.triangles.size());
  groups.forEachEdge([&](std::span<const Index> sides) {
    const Index low = groups.low(sides[0]), high = groups.high(sides[0]);
    if (low == high) return;
    result.edges.push_back({low, high});
    if (sides.size() != 2) return;
    sets.unite(sides[0] / 3, sides[1] / 3, groups.ascends(sides[0]) == groups.ascends(sides[1]));
  });
  result.facing = facingOf(mesh, sets);
  return result;
}

}  // namespace limber
