#include "limber/asset/joint_edit.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_sweep.h"
#include "limber/asset/bind_pose.h"
#include "limber/asset/node_edit.h"
#include "limber/asset/scene_graph.h"

namespace limber {

namespace {

// A joint's name is its node's from now on, so that no other joint changes its name when one comes or goes.
void writeNames(Asset& asset, const AssetSkeleton& skeleton) {
  for (Index j = 0; j < skeleton.jointNode.size(); ++j) {
    Json& node = asset.json()["nodes"][skeleton.jointNode[j]];
    if (nameOf(node) != skeleton.skeleton.joints[j].name) node["name"] = skeleton.skeleton.joints[j].name;
  }
}

void appendMatrix(std::vector<float>& values, const Affine& matrix) {
  for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(matrix.matrix()(i % 4, i / 4)));
}

// Other joints for a skin, each with where it was bound.
void writeSkinJoints(Asset& asset, Index skin, const std::vector<Index>& nodes, const std::vector<float>& matrices) {
  const Index accessor = addFloatAccessor(asset, matrices, 16);
  Json& target = asset.json()["skins"][skin];
  target["joints"] = nodes;
  target["inverseBindMatrices"] = accessor;
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
    for (Index skin = 0; skin < elementCount(asset, "skins"); ++skin) {
      const std::vector<Index> joints = readSkinBinding(asset, skin).joints;
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

void eraseNode(Json& list, Index node) {
  list.erase(std::remove(list.begin(), list.end(), Json(node)), list.end());
}

// Takes a node off what it hangs on: a node, or scenes that show it as a root.
void unhang(Asset& asset, const SceneGraph& graph, Index node) {
  Json& json = asset.json();
  if (graph.parent[node]) {
    Json& above = json["nodes"][*graph.parent[node]];
    eraseNode(above["children"], node);
    if (above["children"].empty()) above.erase("children");
    return;
  }
  const auto scenes = json.find("scenes");
  if (scenes == json.end()) return;
  for (Json& scene : *scenes) {
    if (!scene.contains("nodes")) continue;
    eraseNode(scene["nodes"], node);
    if (scene["nodes"].empty()) scene.erase("nodes");
  }
}

// Below another node, standing in the same place.
void hangNode(Asset& asset, Index node, Index parent) {
  const SceneGraph graph = readSceneGraph(asset);
  const Affine local = graph.world[parent].inverse(Eigen::Affine) * graph.world[node];
  if (!local.matrix().allFinite()) {
    throw Error(ErrorCode::kBadData, "has a scale of 0, so nothing can hang on it", fmt::format("nodes[{}]", parent));
  }
  unhang(asset, graph, node);
  Json& nodes = asset.json()["nodes"];
  nodes[parent]["children"].push_back(node);
  setNodeTransform(nodes[node], local, false);
}

// Node -> its skins' joints without it, with `heir` in its place where nothing would be left.
void takeOutOfSkins(Asset& asset, const BindPose& bind, Index node, Index heir) {
  for (Index skin = 0; skin < elementCount(asset, "skins"); ++skin) {
    const SkinBinding binding = readSkinBinding(asset, skin);
    if (std::find(binding.joints.begin(), binding.joints.end(), node) == binding.joints.end()) continue;
    std::vector<Index> nodes;
    std::vector<float> matrices;
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      if (binding.joints[j] == node) continue;
      nodes.push_back(binding.joints[j]);
      appendMatrix(matrices, binding.inverseBinds[j]);
    }
    if (std::find(nodes.begin(), nodes.end(), heir) == nodes.end()) {
      nodes.push_back(heir);
      appendMatrix(matrices, toJoint(bind.nodeWorld[heir], bind.skinToWorld[skin], heir));
    }
    writeSkinJoints(asset, skin, nodes, matrices);
    Json& target = asset.json()["skins"][skin];
    if (indexMember(target, "skeleton") == node) target.erase("skeleton");
  }
}

bool holdsMore(const Json& node) {
  return node.contains("mesh") || node.contains("camera") || node.contains("extensions");
}

}  // namespace

void addJoint(Asset& asset, const AssetSkeleton& skeleton, Index parent, const Vec3& translation,
              const std::string& name) {
  const AccessorSweep unused(asset);
  const BindPose bind = readBindPose(asset, readSceneGraph(asset));
  const std::vector<Index> skins = skinsOf(asset, skeleton, parent);
  writeNames(asset, skeleton);
  const Index above = skeleton.jointNode[parent];
  Affine local = Affine::Identity();
  local.translation() = translation;
  Json& nodes = asset.json()["nodes"];
  const auto node = static_cast<Index>(nodes.size());
  Json added = {{"name", name}};
  setNodeTransform(added, local, false);
  const double radius = skeleton.skeleton.joints[parent].radius;
  if (radius > 0) added["extras"]["limber_radius"] = shortDouble(radius);
  nodes.push_back(std::move(added));
  nodes[above]["children"].push_back(node);
  for (const Index skin : skins) {
    const SkinBinding binding = readSkinBinding(asset, skin);
    std::vector<Index> joints = binding.joints;
    std::vector<float> matrices;
    for (const Affine& matrix : binding.inverseBinds) appendMatrix(matrices, matrix);
    joints.push_back(node);
    appendMatrix(matrices, toJoint(bind.nodeWorld[above] * local, bind.skinToWorld[skin], node));
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
    takeOutOfSkins(asset, readBindPose(asset, readSceneGraph(asset)), node, skeleton.jointNode[heir]);
    unused.sweep(asset);
  }
  replaceWeights(asset, geometry, skeleton, weights);
  if (!skeleton.skeleton.joints[joint].parent) return;
  const SceneGraph graph = readSceneGraph(asset);
  const Index node = skeleton.jointNode[joint];
  const Json children = elements(asset, "nodes")[node].value("children", Json::array());
  for (const Json& child : children) hangNode(asset, child.get<Index>(), *graph.parent[node]);
  if (holdsMore(elements(asset, "nodes")[node])) return;
  std::vector<bool> keep(graph.nodeCount(), true);
  keep[node] = false;
  deleteNodes(asset, keep);
}

}  // namespace limber
