// What is compared when weights are: a mesh, its skeleton and the weights between them.
#pragma once

#include <vector>

#include "limber/character/character.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/mesh/weld.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

struct SkinnedModel {
  TriMesh mesh;  // vertices as the file has them, not welded, in bind pose
  Skeleton skeleton;
  SkinWeights weights;                 // of #V vertices; need not sum to 1, may be 0 in all slots
  std::vector<StoredVertices> stored;  // how exactly the vertices are known, for prepareMesh
};

// The shaped surface in one bind pose. Throws Error kUnsupported where the character has no rig.
SkinnedModel readSkinnedModel(const Character& character);

// The model with one vertex for each position, that of the lowest vertex there, whose weights it has to a sum of 1, and
// without degenerate triangles. Errors and cost of prepareMesh.
SkinnedModel weldedModel(const SkinnedModel& model);

// Of the box round the surface: vertices without a triangle do not count. 0 where there is no triangle.
double longestSide(const TriMesh& mesh);

}  // namespace limber
