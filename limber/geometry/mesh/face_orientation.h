// The winding of a mesh's faces, where its file does not state it reliably.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// #F: whether a triangle is to be reversed, so that it agrees with its neighbours across every edge of two triangles,
// and the patch of such neighbours faces outwards.
//
// A patch faces outwards where it encloses its own centroid from the right side: a closed one by the sign of its
// volume, an open one where that is clear. Any other faces the side from which more rays leave the model if neighbours
// disagree anywhere in the mesh, and otherwise keeps the winding that most of its area has as stored. Cost: O(#F); rays
// cost a tree over the triangles, and at most 96 queries for each ambiguous open patch.
std::vector<bool> reversedFaces(const TriMesh& mesh);

struct MendedFaces {
  Index repeated = 0, reversed = 0;  // triangles
};

// Removes triangles that have the three vertices of an earlier one, in either winding. Where neighbours then disagree,
// reverses those that reversedFaces names; a mesh whose neighbours agree keeps its bytes.
//
// mesh  each triangle with three different vertices (prepareMesh)
// Cost: O(#F) where neighbours agree, else that of reversedFaces.
MendedFaces mendFaces(TriMesh& mesh);

}  // namespace limber
