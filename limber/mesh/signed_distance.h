// How deep inside a mesh each point of a grid lies.
#pragma once

#include <array>
#include <vector>

#include "limber/mesh/tri_mesh.h"

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
  // resolution  cells along the longest side of the mesh's box, 8 to 512
  // Throws Error kBadArgument for a mesh without triangles.
  SignedDistance(const TriMesh& mesh, const Bvh& surface, const WindingNumber& winding, Index resolution);

  double spacing() const { return spacing_; }
  const std::array<Index, 3>& size() const { return size_; }  // nodes along each axis
  std::size_t nodeCount() const { return values_.size(); }
  std::size_t nodeAt(Index x, Index y, Index z) const { return (std::size_t{z} * size_[1] + y) * size_[0] + x; }
  Vec3 position(std::size_t node) const;
  float value(std::size_t node) const { return values_[node]; }

  // Linear between nodes; beyond the grid the value at its border, and as much more as the border is far.
  double at(const Vec3& point) const;
  // Of at(), by central differences of one spacing.
  Vec3 gradientAt(const Vec3& point) const;

 private:
  void refine(const Bvh& surface, const WindingNumber& winding);
  void measure(const std::vector<std::size_t>& nodes, const Bvh& surface, const WindingNumber& winding);
  void settle(Index step, std::vector<char>& known, std::vector<std::size_t>& wanted);

  Vec3 origin_ = Vec3::Zero();
  double spacing_ = 1;
  std::array<Index, 3> size_ = {};
  std::vector<float> values_;
};

}  // namespace limber
