#include "limber/document/rig/joint_edit.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/joint_radius.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

namespace {

// A joint's name is its node's from now on, so that no other joint changes its name when one comes or goes.
void writeNames(Asset& asset, const AssetSkeleton& skeleton) {
  for (Index j = 0; j < skeleton.jointNode.size(); ++j) {
    asset.document.nodes[skeleton.jointNode[j]].name = skeleton.skeleton.joints[j].name;
  }
}

// Other joints for a skin, each with where it was bound.
void writeSkinJoints(Asset& asset, Index skin, const std::vector<Index>& nodes, const std::vector<float>& matrices) {
  gltf::Skin& target = asset.document.skins[skin];
  target.joints = nodes;
  target.inverseBindMatrices = addFloatAccessor(asset, matrices, 16);
}

// Mesh space of the skin -> a joint that is bound at `bind` in the world.
Affine toJoint(const Affine& bind, const Affine& skinToWorld, Index node) {
  const Affine matrix = bind.inverse(Eigen::Affine) * skinToWorld;
  if (matrix.matrix().allFinite()) return matrix;
  throw Error(ErrorCode::kBadData, "has a bind pose without an inverse", fmt::format("nodes[{}]", node));
}

// Skins that the joint, or else the nearest above or below it that has one, belongs to.
std::vector<Index> skinsOf(const Asset& asset, const AssetSkeleton& skeleton, Index joint) {
  const auto with = [&](Index node) {
    std::vector<Index> skins;
    for (Index skin = 0; skin < asset.document.skins.size(); ++skin) {
      const std::vector<Index>& joints = asset.document.skins[skin].joints;
      if (std::find(joints.begin(), joints.end(), node) != joints.end()) skins.push_back(skin);
    }
    return skins;
  };
  for (std::optional<Index> above = joint; above; above = skeleton.skeleton.joints[*above].parent) {
    std::vector<Index> skins = with(skeleton.jointNode[*above]);
    if (!skins.empty()) return skins;
  }
  return {};
}

// Takes a node off what it hangs on: a node, or scenes that show it as a root.
void unhang(gltf::Document& document, const SceneGraph& graph, Index node) {
  if (graph.parent[node]) {
    std::erase(document.nodes[*graph.parent[node]].children, node);
    return;
  }
  for (gltf::Scene& scene : document.scenes) std::erase(scene.nodes, node);
}

// Makes the node a child of another and keeps its world transform.
void hangNode(Asset& asset, Index node, Index parent) {
  const SceneGraph graph = readSceneGraph(asset.document);
  const Affine local = graph.world[parent].inverse(Eigen::Affine) * graph.world[node];
  if (!local.matrix().allFinite()) {
    throw Error(ErrorCode::kBadData, "has a scale of 0, so nothing can hang on it", fmt::format("nodes[{}]", parent));
  }
  unhang(asset.document, graph, node);
  asset.document.nodes[parent].children.push_back(node);
  setNodeTransform(asset.document.nodes[node], local, false);
}

// Removes the node from its skins' joints; `heir` replaces it in skins that do not have it yet.
void takeOutOfSkins(Asset& asset, const BindPose& bind, Index node, Index heir) {
  for (Index skin = 0; skin < asset.document.skins.size(); ++skin) {
    const SkinBinding binding = readSkinBinding(asset, skin);
    if (std::find(binding.joints.begin(), binding.joints.end(), node) == binding.joints.end()) continue;
    std::vector<Index> nodes;
    std::vector<float> matrices;
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      if (binding.joints[j] == node) continue;
      nodes.push_back(binding.joints[j]);
      appendMatrix(binding.inverseBinds[j], matrices);
    }
    if (std::find(nodes.begin(), nodes.end(), heir) == nodes.end()) {
      nodes.push_back(heir);
      appendMatrix(toJoint(bind.nodeWorld[heir], bind.skinToWorld[skin], heir), matrices);
    }
    writeSkinJoints(asset, skin, nodes, matrices);
    std::optional<Index>& root = asset.document.skins[skin].skeleton;
    if (root == node) root.reset();
  }
}

bool holdsMore(const gltf::Node& node) {
  return node.mesh || node.camera || node.extensions.exists();
}

}  // namespace

void addJoint(Asset& asset, const AssetSkeleton& skeleton, Index parent, const Vec3& translation,
              const std::string& name) {
  const AccessorSweep unused(asset);
  const BindPose bind = readBindPose(asset, readSceneGraph(asset.document));
  const std::vector<Index> skins = skinsOf(asset, skeleton, parent);
  writeNames(asset, skeleton);
  const Index above = skeleton.jointNode[parent];
  Affine local = Affine::Identity();
  local.translation() = translation;
  gltf::Node added;
  added.name = name;
  setNodeTransform(added, local, false);
  const double radius = skeleton.skeleton.joints[parent].radius;
  if (radius > 0) storeRadius(added, radius);
  const Index node = addElement(asset.document.nodes, std::move(added));
  asset.document.nodes[above].children.push_back(node);
  for (const Index skin : skins) {
    const SkinBinding binding = readSkinBinding(asset, skin);
    std::vector<Index> joints = binding.joints;
    std::vector<float> matrices;
    for (const Affine& matrix : binding.inverseBinds) appendMatrix(matrix, matrices);
    joints.push_back(node);
    appendMatrix(toJoint(bind.nodeWorld[above] * local, bind.skinToWorld[skin], node), matrices);
    writeSkinJoints(asset, skin, joints, matrices);
  }
  unused.sweep(asset);
}

void hangJoint(Asset& asset, const AssetSkeleton& skeleton, Index joint, Index parent) {
  writeNames(asset, skeleton);
  hangNode(asset, skeleton.jointNode[joint], skeleton.jointNode[parent]);
}

void removeJoint(Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton, const SkinWeights& weights,
                 Index joint, Index heir) {
  {
    const AccessorSweep unused(asset);
    writeNames(asset, skeleton);
    const Index node = skeleton.jointNode[joint];
    takeOutOfSkins(asset, readBindPose(asset, readSceneGraph(asset.document)), node, skeleton.jointNode[heir]);
    unused.sweep(asset);
  }
  replaceWeights(asset, geometry, skeleton, weights);
  if (!skeleton.skeleton.joints[joint].parent) return;
  const SceneGraph graph = readSceneGraph(asset.document);
  const Index node = skeleton.jointNode[joint];
  const std::vector<Index> children = asset.document.nodes[node].children;
  for (const Index child : children) hangNode(asset, child, *graph.parent[node]);
  if (holdsMore(asset.document.nodes[node])) return;
  std::vector<bool> keep(graph.nodeCount(), true);
  keep[node] = false;
  deleteNodes(asset, keep);
}

}  // namespace limber
