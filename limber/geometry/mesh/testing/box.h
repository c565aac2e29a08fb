// A closed box, for tests. Not installed.
#pragma once

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

inline void addBox(TriMesh& mesh, const Vec3f& low, const Vec3f& high) {
  const Index first = mesh.vertexCount();
  for (Index corner = 0; corner < 8; ++corner) {
    mesh.positions.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                corner & 4 ? high.z() : low.z());
  }
  for (const auto& [a, b, c] : {Triangle{0, 2, 1},
                                {1, 2, 3},
                                {4, 5, 6},
                                {5, 7, 6},
                                {0, 1, 4},
                                {1, 5, 4},
                                {2, 6, 3},
                                {3, 6, 7},
                                {0, 4, 2},
                                {2, 4, 6},
                                {1, 3, 5},
                                {3, 7, 5}}) {
    mesh.triangles.push_back({first + a, first + b, first + c});
  }
}

}  // namespace limber::testing
