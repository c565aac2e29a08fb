// Vertices without a triangle.
#pragma once

#include <optional>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

struct BareSurface {
  TriMesh mesh;               // without loose vertices, the others in their order
  std::vector<Index> source;  // by vertex of it: which it was
};

// nullopt where the mesh has no loose vertex, or no triangle. Cost: O(#V + #F).
std::optional<BareSurface> withoutLooseVertices(const TriMesh& mesh);

}  // namespace limber
