// Does what a program gave back lie in the space that it was given? Swapped axes and other units are common.
#pragma once

#include <string>
#include <vector>

#include "limber/core/types.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// The box of what has triangles.
Box surfaceBox(const TriMesh& mesh);

// Throws Error kBadData where the boxes differ by more than 2 % of the longer one's longest side, and says whether axes
// are swapped, the size is another, or it is merely elsewhere.
void checkSameBox(const Box& returned, const Box& own, const std::string& where);

// Throws Error kBadData where the joints lie far outside the surface's box, or nearer to the vertices that they move
// with axes swapped or turned round than as they are. Without weights only the box can tell.
//
// surface  longest side about 1
// weights  of its vertices; null: none
void checkJointSpace(const Skeleton& skeleton, const TriMesh& surface, const SkinWeights* weights,
                     const std::string& where);

// A joint's rest position seen from one above it, without the skeleton's rotations.
struct JointOffset {
  std::string name;
  Vec3 own, returned;
};

// Throws Error kBadData where offsets differ by more than 1 % of the longest one's length, and says whether the
// skeleton has another size, its axes swapped, or which joint lies elsewhere.
void checkSameOffsets(const std::vector<JointOffset>& offsets, const std::string& where);

}  // namespace limber
