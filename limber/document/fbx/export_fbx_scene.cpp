#include "limber/document/fbx/export_fbx_scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

// Beyond single precision.
bool losesShear(const Affine& affine, const Transform& decomposed) {
  constexpr double kTolerance = 1e-5;
  const Mat3 off = affine.linear() - decomposed.toAffine().linear();
  return off.cwiseAbs().maxCoeff() > kTolerance * affine.linear().cwiseAbs().maxCoeff();
}

class FbxSceneReader {
 public:
  explicit FbxSceneReader(const Asset& asset) : asset_(asset), document_(asset.document) {
    scene_.graph = readSceneGraph(document_);
    scene_.bindPose = readBindPose(asset, scene_.graph);
    scene_.modelOfNode.resize(document_.nodes.size());
  }

  FbxScenePlan read() {
    findLimbs();
    findMoving();
    const std::vector<Index>& order = scene_.graph.order;
    const bool hasMesh = std::any_of(order.begin(), order.end(), [&](Index n) { return shows(n); });
    if (hasMesh) geometry_ = collectGeometry(asset_);
    for (const Index n : order) nodeNames_.push_back(nameOf(n));
    for (std::size_t i = 0; i < order.size(); ++i) addNode(order[i], nodeNames_[i]);
    return std::move(scene_);
  }

 private:
  void findLimbs() {
    isLimb_.assign(document_.nodes.size(), false);
    if (document_.skins.empty() && !isSkeletonAlone(asset_)) return;
    const bool knowsJoints = !document_.skins.empty() || !document_.animations.empty();
    const std::vector<Index> joints = knowsJoints ? animatedSkeleton(asset_).jointNode : scene_.graph.order;
    for (const Index joint : joints) isLimb_[joint] = true;
  }

  // Nodes at or below one that moves or is a joint.
  void findMoving() {
    moves_ = animatedNodes(document_);
    for (const Index n : scene_.graph.allNodes) {
      const std::optional<Index> parent = scene_.graph.parent[n];
      moves_[n] = moves_[n] || isLimb_[n] || (parent && moves_[*parent]);
    }
  }

  std::string nameOf(Index n) {
    const gltf::Node& node = document_.nodes[n];
    std::string wanted = node.name;
    if (wanted.empty() && node.mesh) wanted = document_.meshes[*node.mesh].name;
    if (wanted.empty()) wanted = fmt::format("node_{}", n);
    std::string name = names_.add(wanted);
    if (name != wanted) {
      scene_.warnings.add("renamed-nodes", "nodes of a name that was taken have a number behind it", name);
    }
    return name;
  }

  // Does the node show anything with triangles?
  bool shows(Index n) const {
    const std::optional<Index> mesh = document_.nodes[n].mesh;
    if (!mesh) return false;
    const std::vector<gltf::Primitive>& primitives = document_.meshes[*mesh].primitives;
    return std::any_of(primitives.begin(), primitives.end(), [&](const gltf::Primitive& primitive) {
      const std::optional<Index> positions = primitive.attributes.find("POSITION");
      if (!positions || primitive.mode < gltf::kTriangles) return false;
      return accessorInfo(asset_, primitive.indices.value_or(*positions)).count >= 3;
    });
  }

  void addNode(Index n, const std::string& name) {
    const gltf::Node& node = document_.nodes[n];
    if (node.mesh && !shows(n)) scene_.warnings.add("points-and-lines", "points and lines are left out", name);
    if (node.camera || extensionOf(node, "KHR_lights_punctual")) {
      scene_.warnings.add("cameras-and-lights", "of cameras and lights the node alone is written", name);
    }
    const bool isShown = shows(n);
    const bool isSkinned = isShown && node.skin;
    const bool isInstanced = isShown && !isSkinned && !instancingOf(node, name).empty();
    const bool isMeshItself = isShown && !isLimb_[n] && !isInstanced && !(isSkinned && !node.children.empty());
    if (isSkinned && isMeshItself) return addSkinned(n, name);

    FbxModelPlan model;
    model.kind = isLimb_[n] ? FbxModelKind::kLimb : isMeshItself ? FbxModelKind::kMesh : FbxModelKind::kNull;
    model.name = name;
    model.node = n;
    if (scene_.graph.parent[n]) model.parent = scene_.modelOfNode[*scene_.graph.parent[n]];
    model.local = transformOf(model.parent ? scene_.graph.local[n] : scene_.graph.world[n], name);
    model.bindWorld = scene_.bindPose.nodeWorld[n];
    if (isMeshItself) show(model, n);
    scene_.modelOfNode[n] = scene_.models.size();
    scene_.models.push_back(std::move(model));
    if (!isShown || isMeshItself) return;
    if (isSkinned) return addSkinned(n, names_.add(name + "_mesh"));
    addBelow(n, name);
  }

  void show(FbxModelPlan& model, Index n) const {
    model.kind = FbxModelKind::kMesh;
    model.meshNode = n;
    model.mesh = document_.nodes[n].mesh;
    model.skin = document_.nodes[n].skin;
  }

  // Rigid meshes below the model of their node: one, or its instances.
  void addBelow(Index n, const std::string& name) {
    const Affine& above = scene_.bindPose.nodeWorld[n];
    std::optional<Index> lastCopy;
    for (const PrimitiveInstance& instance : instancesOf(n)) {
      if (lastCopy == instance.copy) continue;
      lastCopy = instance.copy;
      FbxModelPlan model;
      model.name = names_.add(name + "_mesh");
      model.parent = scene_.modelOfNode[n];
      model.local = transformOf(relativeTo(above, instance.toWorld), model.name);
      model.bindWorld = instance.toWorld;
      show(model, n);
      scene_.models.push_back(std::move(model));
    }
  }

  // A node's part of the geometry: nodes are met in the same order there.
  std::span<const PrimitiveInstance> instancesOf(Index n) {
    const auto begin =
        std::find_if(geometry_.instances.begin() + static_cast<std::ptrdiff_t>(nextInstance_),
                     geometry_.instances.end(), [&](const PrimitiveInstance& instance) { return instance.node == n; });
    const auto end = std::find_if(begin, geometry_.instances.end(),
                                  [&](const PrimitiveInstance& instance) { return instance.node != n; });
    nextInstance_ = static_cast<std::size_t>(end - geometry_.instances.begin());
    const auto count = static_cast<std::size_t>(end - begin);
    return std::span<const PrimitiveInstance>(geometry_.instances).subspan(nextInstance_ - count, count);
  }

  static Affine relativeTo(const Affine& above, const Affine& world) {
    if (above.matrix() == world.matrix()) return Affine::Identity();
    const Affine relative = above.inverse(Eigen::Affine) * world;
    return relative.matrix().allFinite() ? relative : Affine::Identity();
  }

  void addSkinned(Index n, const std::string& name) {
    FbxModelPlan model;
    model.name = name;
    model.bindWorld = scene_.bindPose.skinToWorld[*document_.nodes[n].skin];
    show(model, n);
    const std::optional<Index> parent = scene_.graph.parent[n];
    Affine local = model.bindWorld;
    if (parent && scene_.modelOfNode[*parent] && !moves_[*parent]) {
      const Affine below = scene_.graph.world[*parent].inverse(Eigen::Affine) * model.bindWorld;
      if (below.matrix().allFinite() && !losesShear(below, decompose(below))) {
        model.parent = scene_.modelOfNode[*parent];
        local = below;
      }
    }
    model.local = transformOf(local, name);
    scene_.models.push_back(std::move(model));
  }

  Transform transformOf(const Affine& local, const std::string& name) {
    const Transform transform = decompose(local);
    if (losesShear(local, transform))
      scene_.warnings.add("sheared-nodes", "nodes that are sheared lose the shear", name);
    return transform;
  }

  const Asset& asset_;
  const gltf::Document& document_;
  FbxScenePlan scene_;
  Geometry geometry_;
  std::size_t nextInstance_ = 0;
  UniqueNames names_;
  std::vector<std::string> nodeNames_;
  std::vector<bool> isLimb_, moves_;  // #nodes
};

}  // namespace

FbxScenePlan readFbxScene(const Asset& asset) {
  return FbxSceneReader(asset).read();
}

}  // namespace limber
