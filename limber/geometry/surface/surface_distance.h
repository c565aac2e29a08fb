// How far points of a surface are from one of them, along the surface.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/mesh/vertex_triangles.h"

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
  std::vector<Index> neighbours(Index vertex) const { return neighboursOf(vertex, mesh_.triangles, trianglesAt_); }

 private:
  TriMesh mesh_;
  Grouped<Index> trianglesAt_;
};

}  // namespace limber
