#include "limber/document/import/import_scene.h"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/import/import_animation.h"
#include "limber/document/import/import_material.h"
#include "limber/document/import/import_mesh.h"
#include "limber/document/import/import_skin.h"
#include "limber/document/import/import_text.h"
#include "limber/document/rig/skin_roots.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

class SceneConverter {
 public:
  SceneConverter(const aiScene& scene, const ImportIo& io, double scale, const Mat3& axes)
      : scene_(scene), scale_(scale), materials_(asset_, scene, io), skins_(scene) {
    axes_.linear() = axes;
  }

  Asset convert() {
    document_.about.generator = "limber";
    findAnimated();
    planSkins(*scene_.mRootNode);
    addNodes();
    for (const SkinnedPart& part : parts_) addSkinnedPart(part);
    if (!document_.nodes.empty()) {
      document_.scene = 0;
      document_.scenes.emplace_back().nodes = roots_;
      joinSkinRoots(document_, names_);
    }
    importAnimations(asset_, scene_, nodeOf_, scale_);
    warnOfOthers();
    return std::move(asset_);
  }

 private:
  struct SkinnedPart {
    const aiNode* owner;
    ImportSkin skin;
  };

  void findAnimated() {
    for (unsigned a = 0; a < scene_.mNumAnimations; ++a) {
      for (unsigned c = 0; c < scene_.mAnimations[a]->mNumChannels; ++c) {
        if (const aiNode* node = skins_.node(scene_.mAnimations[a]->mChannels[c]->mNodeName)) animated_.insert(node);
      }
    }
  }

  void planSkins(const aiNode& node) {
    for (ImportSkin& skin : skins_.skinsOf(node)) {
      for (const aiNode* joint : skin.joints) joints_.insert(joint);
      parts_.push_back({&node, std::move(skin)});
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c) planSkins(*node.mChildren[c]);
  }

  std::vector<unsigned> rigidMeshes(const aiNode& node) const {
    std::vector<unsigned> meshes;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
      if (!scene_.mMeshes[node.mMeshes[m]]->HasBones()) meshes.push_back(node.mMeshes[m]);
    }
    return meshes;
  }

  // A node that serves no purpose once its skinned meshes are nodes of their own: the nameless top of most formats'
  // trees, and a leaf that contained only such meshes.
  bool isSuperfluous(const aiNode& node) const {
    if (animated_.count(&node) > 0 || joints_.count(&node) > 0 || !rigidMeshes(node).empty()) return false;
    if (node.mParent == nullptr) return localOf(node).isApprox(Affine::Identity(), 0);
    return node.mNumChildren == 0 && node.mNumMeshes > 0;
  }

  Affine localOf(const aiNode& node) const {
    const Affine local = scaledAffine(node.mTransformation, scale_);
    return node.mParent ? local : axes_ * local;
  }

  void addNodes() {
    std::vector<const aiNode*> stack = {scene_.mRootNode};
    while (!stack.empty()) {
      const aiNode* node = stack.back();
      stack.pop_back();
      if (!isSuperfluous(*node)) addNode(*node);
      for (unsigned c = node->mNumChildren; c-- > 0;) stack.push_back(node->mChildren[c]);
    }
  }

  void addNode(const aiNode& node) {
    gltf::Node result;
    const std::string name = textOf(node.mName);
    if (!name.empty()) result.name = names_.add(name);
    setNodeTransform(result, localOf(node), animated_.count(&node) == 0 && joints_.count(&node) == 0);
    const std::vector<unsigned> meshes = rigidMeshes(node);
    if (!meshes.empty()) result.mesh = rigidMesh(meshes, name);

    const Index index = addElement(document_.nodes, std::move(result));
    nodeOf_[&node] = index;
    const auto parent = node.mParent ? nodeOf_.find(node.mParent) : nodeOf_.end();
    (parent == nodeOf_.end() ? roots_ : document_.nodes[parent->second].children).push_back(index);
  }

  std::optional<Index> rigidMesh(const std::vector<unsigned>& meshes, const std::string& nodeName) {
    const auto known = rigidMeshes_.find(meshes);
    if (known != rigidMeshes_.end()) return known->second;
    std::vector<gltf::Primitive> primitives;
    for (const unsigned m : meshes) appendPrimitives(primitives, *scene_.mMeshes[m], {}, 0);
    return rigidMeshes_[meshes] = addMesh(std::move(primitives), nodeName);
  }

  void appendPrimitives(std::vector<gltf::Primitive>& primitives, const aiMesh& mesh, const SkinWeights& weights,
                        Index joints) {
    for (gltf::Primitive& primitive : importPrimitives(asset_, mesh, scale_, weights, joints)) {
      if (mesh.mMaterialIndex < scene_.mNumMaterials) primitive.material = materials_.material(mesh.mMaterialIndex);
      primitives.push_back(std::move(primitive));
    }
    asset_.warnings.add("morph-targets", "morph targets are left out", textOf(mesh.mName), mesh.mNumAnimMeshes);
  }

  std::optional<Index> addMesh(std::vector<gltf::Primitive> primitives, const std::string& name) {
    if (primitives.empty()) return std::nullopt;
    gltf::Mesh mesh;
    mesh.name = name;
    mesh.primitives = std::move(primitives);
    return addElement(document_.meshes, std::move(mesh));
  }

  void addSkinnedPart(const SkinnedPart& part) {
    const ImportSkin& skin = part.skin;
    std::vector<gltf::Primitive> primitives;
    for (const unsigned m : skin.meshes) {
      appendPrimitives(primitives, *scene_.mMeshes[m], skins_.weightsOf(*scene_.mMeshes[m], skin),
                       static_cast<Index>(skin.joints.size()));
    }
    const std::string name = textOf(part.owner->mName);
    const std::optional<Index> mesh = addMesh(std::move(primitives), name);
    if (!mesh) return;

    std::vector<float> inverseBinds;
    gltf::Skin bound;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
      appendMatrix(scaledAffine(skin.inverseBinds[j], scale_), inverseBinds);
      bound.joints.push_back(nodeOf_.at(skin.joints[j]));
    }
    bound.inverseBindMatrices = addFloatAccessor(asset_, inverseBinds, 16);
    gltf::Node node;
    if (!name.empty()) node.name = names_.add(nodeOf_.count(part.owner) > 0 ? name + "_skinned" : name);
    node.mesh = mesh;
    node.skin = addElement(document_.skins, std::move(bound));
    roots_.push_back(addElement(document_.nodes, std::move(node)));
  }

  void warnOfOthers() {
    asset_.warnings.add("lights", "lights are left out", {}, scene_.mNumLights);
    asset_.warnings.add("cameras", "cameras are left out", {}, scene_.mNumCameras);
  }

  const aiScene& scene_;
  double scale_;
  Affine axes_ = Affine::Identity();
  Asset asset_;
  gltf::Document& document_ = asset_.document;
  MaterialImporter materials_;
  SkinImporter skins_;
  UniqueNames names_;
  std::set<const aiNode*> animated_, joints_;
  std::vector<SkinnedPart> parts_;
  std::map<const aiNode*, Index> nodeOf_;
  std::map<std::vector<unsigned>, std::optional<Index>> rigidMeshes_;
  std::vector<Index> roots_;
};

}  // namespace

Asset convertScene(const aiScene& scene, const ImportIo& io, double scale, const Mat3& axes) {
  return SceneConverter(scene, io, scale, axes).convert();
}

}  // namespace limber
