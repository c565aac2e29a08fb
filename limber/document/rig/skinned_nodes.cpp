#include "limber/document/rig/skinned_nodes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

std::vector<MeshGroup> groupsOf(const Geometry& geometry) {
  std::vector<MeshGroup> groups;
  for (Index i = 0; i < geometry.instances.size(); ++i) {
    const PrimitiveInstance& instance = geometry.instances[i];
    const bool same = !groups.empty() && groups.back().node == instance.node && groups.back().copy == instance.copy;
    if (!same) groups.push_back({instance.node, instance.mesh, instance.copy, i, i, instance.toWorld});
    groups.back().endInstance = i + 1;
  }
  return groups;
}

std::array<double, 12> numbersOf(const Affine& affine) {
  std::array<double, 12> numbers;
  for (int i = 0; i < 12; ++i) numbers[i] = affine.matrix()(i % 3, i / 3) + 0.0;
  return numbers;
}

}  // namespace

SkinnedNodes::SkinnedNodes(Asset& asset, const Geometry& geometry, std::vector<bool> carries)
    : asset_(asset), graph_(readSceneGraph(asset.document)), carries_(std::move(carries)), groups_(groupsOf(geometry)) {
  carries_.resize(graph_.nodeCount(), false);
  animated_ = animatedNodes(asset.document);
  scenesOf_.resize(graph_.nodeCount());
  for (Index scene = 0; scene < asset.document.scenes.size(); ++scene) {
    for (const Index node : sceneNodes(asset.document, scene)) scenesOf_[node].push_back(scene);
  }

  // A mesh may be changed in place if all nodes that show it are among those that become skinned.
  std::vector<Index> shown(asset.document.meshes.size(), 0), skinned(shown);
  for (const gltf::Node& node : asset.document.nodes) {
    names_.add(node.name);
    if (node.mesh) ++shown[*node.mesh];
  }
  for (const MeshGroup& group : groups_) {
    if (group.copy == 0) ++skinned[group.mesh];
  }
  for (Index mesh = 0; mesh < shown.size(); ++mesh) ownMeshFree_.push_back(shown[mesh] == skinned[mesh]);
}

Index SkinnedNodes::meshFor(const MeshGroup& group) {
  if (ownMeshFree_[group.mesh]) {
    ownMeshFree_[group.mesh] = false;
    return group.mesh;
  }
  return addElement(asset_.document.meshes, gltf::Mesh(asset_.document.meshes[group.mesh]));
}

Index SkinnedNodes::addSkin(const SkinJoints& joints, const Affine& toWorld) {
  const auto [known, isNew] = skins_.try_emplace({joints.nodes, numbersOf(toWorld)}, 0);
  if (!isNew) return known->second;

  std::vector<float> inverseBinds;
  inverseBinds.reserve(16 * joints.toJoint.size());
  for (const Affine& toJoint : joints.toJoint) appendMatrix(toJoint * toWorld, inverseBinds);
  if (!std::all_of(inverseBinds.begin(), inverseBinds.end(), [](float x) { return std::isfinite(x); })) {
    throw Error(ErrorCode::kBadData, "has inverse bind matrices that are not finite", "skin '" + joints.name + "'",
                "the model lies too far from the origin or is scaled too much");
  }
  gltf::Skin skin;
  skin.name = joints.name;
  skin.inverseBindMatrices = addFloatAccessor(asset_, inverseBinds, 16);
  skin.skeleton = joints.skeleton;
  skin.joints = joints.nodes;
  return known->second = addElement(asset_.document.skins, std::move(skin));
}

// Can the node show a mesh that is in world space already?
bool SkinnedNodes::isAtOrigin(const MeshGroup& group) const {
  const gltf::Node& node = asset_.document.nodes[group.node];
  return !graph_.parent[group.node] && group.copy == 0 && !node.hasTransform() &&
         extensionOf(node, kInstancingName) == nullptr;
}

bool SkinnedNodes::loosesAnimation(Index node) const {
  for (std::optional<Index> n = node; n && !carries_[*n]; n = graph_.parent[*n]) {
    if (animated_[*n]) return true;
  }
  return false;
}

// Hands the group's mesh, with its morph weights and their animation, to a new node without a parent.
Index SkinnedNodes::moveToRoot(const MeshGroup& group, const char* suffix) {
  const gltf::Node& source = asset_.document.nodes[group.node];
  gltf::Node node;
  const std::string& name = source.name.empty() ? asset_.document.meshes[group.mesh].name : source.name;
  if (!name.empty()) node.name = names_.add(name + suffix);
  node.weights = source.weights;
  const Index moved = addElement(asset_.document.nodes, std::move(node));

  if (group.copy == 0) retargetMorphChannels(asset_, group.node, moved);
  for (const Index scene : scenesOf_[group.node]) asset_.document.scenes[scene].nodes.push_back(moved);
  return moved;
}

void SkinnedNodes::attach(const MeshGroup& group, Index mesh, Index skin) {
  const bool wasSkinned = asset_.document.nodes[group.node].skin.has_value();  // then it stays as the file has it
  if (!wasSkinned && group.copy == 0 && loosesAnimation(group.node)) ++lostAnimations_;
  const bool stays = wasSkinned || isAtOrigin(group);
  const Index node = stays ? group.node : moveToRoot(group, "_skinned");
  gltf::Node& shown = asset_.document.nodes[node];
  shown.mesh = mesh;
  shown.skin = skin;
  if (!stays) takeMeshOff(group);
}

void SkinnedNodes::attachStatic(const MeshGroup& group, Index mesh) {
  const bool stays = isAtOrigin(group);
  const Index node = stays ? group.node : moveToRoot(group, "_posed");
  gltf::Node& shown = asset_.document.nodes[node];
  shown.mesh = mesh;
  shown.skin.reset();
  shown.weights.clear();
  if (!stays) takeMeshOff(group);
}

// Off the node that a mesh was moved from. The last of a node's instances does it; until then the next ones need to see
// its morph weights.
void SkinnedNodes::takeMeshOff(const MeshGroup& group) {
  const bool last = &group == &groups_.back() || (&group + 1)->node != group.node;
  if (!last) {
    ++expandedInstances_;
    return;
  }
  gltf::Node& old = asset_.document.nodes[group.node];
  old.mesh.reset();
  old.skin.reset();
  old.weights.clear();
  if (eraseExtension(old, kInstancingName)) ++expandedInstances_;
}

void SkinnedNodes::showInScenes(Index root) {
  std::set<Index> scenes;
  for (const MeshGroup& group : groups_) scenes.insert(scenesOf_[group.node].begin(), scenesOf_[group.node].end());
  for (const Index scene : scenes) asset_.document.scenes[scene].nodes.push_back(root);
}

void SkinnedNodes::finish() {
  asset_.warnings.add("node-animation", "meshes are moved by an animation of their node, which no longer moves them",
                      {}, lostAnimations_);
  asset_.warnings.add("expanded-instances", "GPU instances are written as meshes of their own, since these cannot bend",
                      {}, expandedInstances_);
  if (expandedInstances_ == 0) return;
  const std::vector<gltf::Node>& nodes = asset_.document.nodes;
  const bool used = std::any_of(nodes.begin(), nodes.end(),
                                [](const gltf::Node& node) { return extensionOf(node, kInstancingName) != nullptr; });
  if (!used) undeclareExtension(asset_.document, kInstancingName);
}

}  // namespace limber
