// The edges of a triangle mesh, and which of its triangles have to be turned to face outwards.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

using VertexPair = std::array<Index, 2>;  // first < second

struct SurfaceEdges {
  std::vector<VertexPair> edges;    // each once, ordered by first, then second
  std::vector<std::int8_t> facing;  // #F: 1 as stored, -1 to be turned over
};

// Triangles that share an edge with no third one are made to agree; each part of the surface that agrees with itself is
// then turned so that it encloses a positive volume (as seen from its own middle where it is open). Parts that enclose
// next to nothing stay as most of their area is. A Moebius band keeps a seam. Cost: O(#V + #F).
SurfaceEdges surfaceEdges(const TriMesh& mesh);

}  // namespace limber
