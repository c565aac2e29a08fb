// How far points of a surface are from one of them, along the surface.
#pragma once

#include <utility>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

struct VertexDistance {
  Index vertex = 0;
  double distance = 0;  // metres
};

// Distances over the triangles, never through the air or the inside: parts that share no vertex are infinitely far
// apart. A front runs from vertex to vertex, nearest first, and each triangle that it crosses is unfolded into the
// plane, so that on a flat surface distances are right to a few hundredths however it is cut into triangles (after
// Kimmel, Sethian 1998, Computing geodesic paths on manifolds, with the source unfolded instead of the gradient).
class SurfaceDistance {
 public:
  // Welded: vertices at one position are one vertex. Cost: O(#V + #F).
  explicit SurfaceDistance(TriMesh mesh);

  const TriMesh& mesh() const { return mesh_; }

  // The vertices within `radius` of a point of the triangle, nearest first, ties by number. Cost: O(n log n) for the n
  // vertices found.
  std::vector<VertexDistance> within(Index triangle, const Vec3& barycentric, double radius) const;

  // The vertices that share an edge with this one, ascending.
  std::vector<Index> neighbours(Index vertex) const;

 private:
  std::pair<const Index*, const Index*> trianglesAt(Index vertex) const;

  TriMesh mesh_;
  std::vector<Index> firstTriangle_, triangles_;  // #V + 1 into #3F: the triangles at each vertex
};

}  // namespace limber
