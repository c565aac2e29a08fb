// Areas of triangles, and of the surface round each vertex.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

inline double triangleArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  return 0.5 * (b - a).cross(c - a).norm();
}

inline double triangleArea(const TriMesh& mesh, const Triangle& t) {
  return triangleArea(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]));
}

// #V: a third of the area of each triangle at the vertex. Cost: O(#V + #F).
inline std::vector<double> vertexAreas(const TriMesh& mesh) {
  std::vector<double> areas(mesh.vertexCount(), 0);
  for (const Triangle& t : mesh.triangles) {
    const double third = triangleArea(mesh, t) / 3;
    for (const Index v : t) areas[v] += third;
  }
  return areas;
}

}  // namespace limber
