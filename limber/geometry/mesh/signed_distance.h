// How deep inside a mesh each point of a grid lies.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

class Bvh;
class WindingNumber;

// Distances to the surface at the nodes of a regular grid round a mesh: negative inside (winding number above a half),
// positive outside. Found on an adaptive grid: cells that the surface may pass through, or that have nodes of both
// signs, are halved down to the grid's spacing; nodes in other cells take the distance between their corners'.
//
// Cost: O(nodes near the surface) queries of both trees, in parallel.
class SignedDistance {
 public:
  // resolution  cells along the longest side of modelBox, 8 to 512: far pieces lie beyond the grid
  // Throws Error kBadArgument for a mesh without triangles.
  SignedDistance(const TriMesh& mesh, const Bvh& surface, const WindingNumber& winding, Index resolution);

  double spacing() const { return spacing_; }
  const std::array<Index, 3>& size() const { return size_; }  // nodes along each axis
  std::size_t nodeCount() const { return values_.size(); }
  std::size_t nodeAt(Index x, Index y, Index z) const { return (std::size_t{z} * size_[1] + y) * size_[0] + x; }
  Vec3 position(std::size_t node) const;
  float value(std::size_t node) const { return values_[node]; }

  // Linear between nodes; beyond the grid the value at its border, and as much more as the border is far.
  double at(const Vec3& point) const {
    const Vec3 scaled = (point - origin_) * perSpacing_, inside = scaled.cwiseMax(0.0).cwiseMin(last_);
    const double value = between(inside);
    return inside == scaled ? value : value + spacing_ * (scaled - inside).norm();
  }

 private:
  void refine(const Bvh& surface, const WindingNumber& winding);
  void measure(const std::vector<std::size_t>& nodes, const Bvh& surface, const WindingNumber& winding);
  void settle(Index step, std::vector<char>& known, std::vector<std::size_t>& wanted);

  // At a position given in spacings from the first node, not beyond the grid.
  double between(const Vec3& spot) const {
    Index low[3];
    double part[3];
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(static_cast<Index>(spot[axis]), size_[axis] - 2);
      part[axis] = spot[axis] - low[axis];
    }
    const auto mix = [](double a, double b, double fraction) { return a + fraction * (b - a); };
    const auto level = [&](const float* at) {
      const float* next = at + size_[0];
      return mix(mix(at[0], at[1], part[0]), mix(next[0], next[1], part[0]), part[1]);
    };
    const float* corner = &values_[nodeAt(low[0], low[1], low[2])];
    return mix(level(corner), level(corner + std::size_t{size_[0]} * size_[1]), part[2]);
  }

  Vec3 origin_ = Vec3::Zero();
  double spacing_ = 1, perSpacing_ = 1;
  std::array<Index, 3> size_ = {};
  Vec3 last_ = Vec3::Zero();  // node along each axis
  std::vector<float> values_;
};

// Cells along the longest side of modelBox for a grid of about so many nodes in it: more where it is little of a cube;
// between `least` and `most`.
Index cellsForNodes(const TriMesh& mesh, double nodes, double least, double most);

}  // namespace limber
