// Which pieces of a mesh are stored inside out.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// #F: whether the triangle's piece as a whole encloses a negative volume, seen from its own middle. For WindingNumber,
// which counts such triangles as turned round. Cost: O(#V + #F).
std::vector<bool> turnedPieces(const TriMesh& mesh);

}  // namespace limber
