// The connected pieces of a mesh.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// The piece that each vertex belongs to: two vertices are in one piece when triangles that share vertices lead from one
// to the other. A vertex without a triangle is a piece of its own.
//
// Returns #V piece numbers, 0 to *count - 1, numbered in the order of each piece's lowest vertex. `count` may be null.
// Cost: O(#V + #F) in practice (union-find).
std::vector<Index> vertexComponents(const TriMesh& mesh, Index* count = nullptr);

}  // namespace limber
