// What bends an FBX geometry: the clusters of its skin, and its blend shapes.
#pragma once

#include <optional>
#include <vector>

#include "limber/document/fbx/import_fbx_mesh.h"
#include "limber/document/fbx/import_fbx_models.h"

namespace limber {

// A skin over control points that lie in the world as they were bound, in the file's units and directions.
struct FbxSkin {
  std::vector<Index> joints;            // models
  std::vector<Affine> inverseBinds;     // from the bound world to the joint
  Affine toBound = Affine::Identity();  // from the mesh model's space to the bound world
  SkinWeights weights;                  // #control points, eight strongest, sum 1
  bool needsOwnModel = false;  // are there control points without any weight? They follow the mesh's own model,
                               // the last of the joints
};

// Of all clusters of all skins of the geometry; none where it has no usable cluster. Where a cluster lacks a matrix,
// the models' rest transforms stand in. Weights that are not positive and control points out of range are left out,
// counted. Throws Error kLimit beyond the budget.
std::optional<FbxSkin> readFbxSkin(const FbxObjects& objects, const FbxModels& models, Index geometry, Index meshModel,
                                   FbxBudget& budget, Warnings& warnings);

// A channel of blend shapes: targets that come in one after the other as its percentage rises.
struct FbxShapeChannel {
  Index object = 0;
  double percent = 0;                // at rest
  std::vector<Index> targets;        // indices into FbxShapes::targets
  std::vector<double> fullPercents;  // #targets, ascending: where each is reached in full

  // Weights of the targets at a percentage.
  void addWeights(double percentage, std::vector<double>& weights) const;
};

struct FbxShapes {
  std::vector<FbxShapeTarget> targets;
  std::vector<FbxShapeChannel> channels;
};

// Throws Error kLimit beyond the budget.
FbxShapes readFbxShapes(const FbxObjects& objects, Index geometry, FbxBudget& budget, Warnings& warnings);

}  // namespace limber
