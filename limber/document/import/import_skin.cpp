#include "limber/document/import/import_skin.h"

#include <algorithm>
#include <cmath>

#include <assimp/scene.h>
#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/document/import/import_text.h"

namespace limber {

namespace {

constexpr Index kSlots = 8;

// Bones of one name are one joint if they were bound alike; files repeat the matrix for each mesh.
bool sameBind(const aiMatrix4x4& a, const aiMatrix4x4& b) {
  return a.Equal(b, 1e-4f * std::max(1.0f, std::abs(a.a4) + std::abs(a.b4) + std::abs(a.c4)));
}

std::string key(const aiString& name) {
  return std::string(name.data, name.length);
}

struct Influence {
  Index joint;
  float weight;
};

using Influences = std::vector<std::vector<Influence>>;  // #V

Influences influencesOf(const aiMesh& mesh, const ImportSkin& skin) {
  Influences result(mesh.mNumVertices);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const auto joint = skin.jointOf.find(key(bone.mName));
    if (joint == skin.jointOf.end()) continue;
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
      const aiVertexWeight& weight = bone.mWeights[w];
      if (weight.mVertexId >= mesh.mNumVertices) {
        throw Error(ErrorCode::kBadData, fmt::format("bone '{}' names vertex {} of {}", textOf(bone.mName),
                                                     weight.mVertexId, mesh.mNumVertices));
      }
      if (!(weight.mWeight > 0) || !std::isfinite(weight.mWeight)) continue;
      std::vector<Influence>& row = result[weight.mVertexId];
      const auto same =
          std::find_if(row.begin(), row.end(), [&](const Influence& i) { return i.joint == joint->second; });
      if (same != row.end()) {
        same->weight += weight.mWeight;
      } else {
        row.push_back({joint->second, weight.mWeight});
      }
    }
  }
  return result;
}

bool everyVertexWeighed(const aiMesh& mesh) {
  std::vector<bool> weighed(mesh.mNumVertices, false);
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    for (unsigned w = 0; w < mesh.mBones[b]->mNumWeights; ++w) {
      const aiVertexWeight& weight = mesh.mBones[b]->mWeights[w];
      if (weight.mVertexId < weighed.size() && weight.mWeight > 0) weighed[weight.mVertexId] = true;
    }
  }
  return std::find(weighed.begin(), weighed.end(), false) == weighed.end();
}

}  // namespace

Affine scaledAffine(const aiMatrix4x4& m, double scale) {
  Affine result;
  result.matrix() << m.a1, m.a2, m.a3, scale * m.a4, m.b1, m.b2, m.b3, scale * m.b4, m.c1, m.c2, m.c3, scale * m.c4, 0,
      0, 0, 1;
  if (!result.matrix().allFinite()) throw Error(ErrorCode::kBadData, "has a transform that is not finite");
  return result;
}

SkinImporter::SkinImporter(const aiScene& scene) : scene_(scene) {
  std::vector<const aiNode*> stack = {scene.mRootNode};
  while (!stack.empty()) {
    const aiNode* node = stack.back();
    stack.pop_back();
    nodes_.emplace(key(node->mName), node);
    for (unsigned c = node->mNumChildren; c-- > 0;) stack.push_back(node->mChildren[c]);
  }
}

const aiNode* SkinImporter::node(const aiString& name) const {
  const auto found = nodes_.find(key(name));
  return found == nodes_.end() ? nullptr : found->second;
}

std::vector<ImportSkin> SkinImporter::skinsOf(const aiNode& owner) const {
  std::vector<ImportSkin> skins;
  for (unsigned m = 0; m < owner.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene_.mMeshes[owner.mMeshes[m]];
    if (!mesh.HasBones()) continue;
    const auto fits = [&](const ImportSkin& skin) {
      return std::all_of(mesh.mBones, mesh.mBones + mesh.mNumBones, [&](const aiBone* bone) {
        const auto joint = skin.jointOf.find(key(bone->mName));
        return joint == skin.jointOf.end() || sameBind(skin.inverseBinds[joint->second], bone->mOffsetMatrix);
      });
    };
    auto skin = std::find_if(skins.begin(), skins.end(), fits);
    if (skin == skins.end()) skin = skins.insert(skins.end(), ImportSkin());
    skin->meshes.push_back(owner.mMeshes[m]);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
      const aiBone& bone = *mesh.mBones[b];
      const aiNode* joint = node(bone.mName);
      const auto index = static_cast<Index>(skin->joints.size());
      if (!joint || !skin->jointOf.emplace(key(bone.mName), index).second) continue;
      skin->joints.push_back(joint);
      skin->inverseBinds.push_back(bone.mOffsetMatrix);
    }
    if (!everyVertexWeighed(mesh) || skin->joints.empty()) skin->stand = &owner;
  }
  for (ImportSkin& skin : skins) {
    if (!skin.stand) continue;
    // The owner may be a bone itself; then that bone's own joint must do, since joints are listed once.
    const auto known = std::find(skin.joints.begin(), skin.joints.end(), skin.stand);
    if (known != skin.joints.end()) continue;
    skin.joints.push_back(skin.stand);
    skin.inverseBinds.emplace_back();
  }
  return skins;
}

SkinWeights SkinImporter::weightsOf(const aiMesh& mesh, const ImportSkin& skin) const {
  Influences influences = influencesOf(mesh, skin);
  const auto stand = std::find(skin.joints.begin(), skin.joints.end(), skin.stand) - skin.joints.begin();
  SkinWeights result;
  result.slots = kSlots;
  result.joints.assign(influences.size() * kSlots, 0);
  result.weights.assign(influences.size() * kSlots, 0.0f);
  for (std::size_t v = 0; v < influences.size(); ++v) {
    std::vector<Influence>& row = influences[v];
    if (row.empty()) row.push_back({static_cast<Index>(stand), 1.0f});
    std::stable_sort(row.begin(), row.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    row.resize(std::min<std::size_t>(row.size(), kSlots), {0, 0.0f});
    for (std::size_t i = 0; i < row.size(); ++i) {
      result.joints[v * kSlots + i] = row[i].joint;
      result.weights[v * kSlots + i] = row[i].weight;
    }
  }
  return result;
}

}  // namespace limber
