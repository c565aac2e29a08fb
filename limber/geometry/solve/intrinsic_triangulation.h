// Triangles that know only their edge lengths and what they are glued to: the ground on which the Laplacian of any
// triangle soup becomes well behaved.
#pragma once

#include <vector>

#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// Face f has the sides 3f, 3f+1, 3f+2; side h runs from corner `from[h]` to corner `from[nextSide(h)]` and is glued to
// side `twin[h]`, which runs in the opposite direction. Every side is glued, so there is no boundary. Sides of one face
// may be glued to each other, and a side may run from a vertex to itself.
struct IntrinsicTriangulation {
  std::vector<Index> from;        // #H
  std::vector<Index> twin;        // #H
  std::vector<double> length;     // #H, positive; equal for twins
  std::vector<double> cotangent;  // #H, of the angle opposite the side; empty until delaunayFlips
  std::vector<char> twoSided;     // #V: 1 where the vertex's piece was covered on both sides

  Index sideCount() const { return static_cast<Index>(from.size()); }
};

// The tufted cover of Sharp, Crane 2020: a front and a back copy of every triangle, glued around each edge to the
// copies that they face, so that any mesh becomes edge-manifold and closed. A piece that is closed, edge-manifold and
// consistently oriented would fall into two equal covers, so only its front is made; `twoSided` tells which is which.
//
// Edge lengths are mollified where triangles are degenerate or nearly so: one small length is added to all, at most
// 1e-5 of the mean, so that each triangle inequality holds by that margin.
//
// piece  #V, from vertexComponents(mesh)
// Triangles with a repeated vertex are left out.
// Cost: O(#F) besides sorting the triangles around edges of three and more.
IntrinsicTriangulation tuftedCover(const TriMesh& mesh, const std::vector<Index>& piece);

// Flips edges until all are intrinsically Delaunay (opposite angles sum to at most pi), which makes every edge's
// cotangent weight nonnegative, and fills `cotangent`. Returns the number of flips.
// Cost: O(#H) plus the flips, few in practice (bounded, should rounding ever make it run on).
Index delaunayFlips(IntrinsicTriangulation& triangulation);

}  // namespace limber
