// What is compared when weights are: a mesh, its skeleton and the weights between them.
#pragma once

#include <vector>

#include "limber/mesh/tri_mesh.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

class Asset;

struct SkinnedModel {
  TriMesh mesh;  // vertices as the file has them, not welded, in bind pose
  Skeleton skeleton;
  SkinWeights weights;  // of #V vertices; need not sum to 1, may be 0 in all slots
};

// Throws Error kUnsupported where the asset has no rig.
SkinnedModel readSkinnedModel(const Asset& asset);

}  // namespace limber
