// Assimp gives each mesh bones of its own; glTF wants one skin for all meshes of a node.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <assimp/matrix4x4.h>

#include "limber/core/types.h"
#include "limber/skeleton/skin_weights.h"

struct aiMesh;
struct aiNode;
struct aiScene;
struct aiString;

namespace limber {

// An affine map out of Assimp with lengths multiplied by `scale`: the linear part stays, the translation grows.
Affine scaledAffine(const aiMatrix4x4& matrix, double scale);

struct ImportSkin {
  std::vector<unsigned> meshes;           // of the scene
  std::vector<const aiNode*> joints;      // #J
  std::vector<aiMatrix4x4> inverseBinds;  // #J
  std::map<std::string, Index> jointOf;   // bone name -> joint
  const aiNode* stand = nullptr;          // what vertices without any weight hang on: the node of the mesh
};

class SkinImporter {
 public:
  explicit SkinImporter(const aiScene& scene);

  // The first node of that name, null if there is none.
  const aiNode* node(const aiString& name) const;

  // The skins of the meshes of one node: one, unless meshes disagree on where a bone was bound.
  std::vector<ImportSkin> skinsOf(const aiNode& node) const;

  // The weights of one of the skin's meshes, eight strongest of each vertex, sum 1. Throws Error kBadData for a bone
  // that names a vertex out of range.
  SkinWeights weightsOf(const aiMesh& mesh, const ImportSkin& skin) const;

 private:
  const aiScene& scene_;
  std::map<std::string, const aiNode*> nodes_;
};

}  // namespace limber
