#include "limber/asset/skinned_nodes.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/extensions.h"
#include "limber/asset/node_edit.h"

namespace limber {

namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

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

std::vector<bool> animatedNodes(const Asset& asset, Index nodeCount) {
  std::vector<bool> animated(nodeCount, false);
  const Json& animations = elements(asset, "animations");
  for (const Json& animation : animations) {
    for (const Json& channel : animation.at("channels")) {
      const Json* target = member(channel, "target");
      const Json* path = target ? member(*target, "path") : nullptr;
      const std::optional<Index> node = target ? indexMember(*target, "node") : std::nullopt;
      if (node && *node < nodeCount && path && *path != "weights") animated[*node] = true;
    }
  }
  return animated;
}

std::array<double, 12> numbersOf(const Affine& affine) {
  std::array<double, 12> numbers;
  for (int i = 0; i < 12; ++i) numbers[i] = affine.matrix()(i % 3, i / 3) + 0.0;
  return numbers;
}

}  // namespace

SkinnedNodes::SkinnedNodes(Asset& asset, const Geometry& geometry, std::vector<bool> carries)
    : asset_(asset), graph_(readSceneGraph(asset)), carries_(std::move(carries)), groups_(groupsOf(geometry)) {
  carries_.resize(graph_.nodeCount(), false);
  animated_ = animatedNodes(asset, graph_.nodeCount());
  scenesOf_.resize(graph_.nodeCount());
  for (Index scene = 0; scene < elementCount(asset, "scenes"); ++scene) {
    for (const Index node : sceneNodes(asset, scene)) scenesOf_[node].push_back(scene);
  }

  // A mesh may be changed in place if all nodes that show it are among those that become skinned.
  std::vector<Index> shown(elementCount(asset, "meshes"), 0), skinned(shown);
  for (const Json& node : elements(asset, "nodes")) {
    names_.add(nameOf(node));
    if (const std::optional<Index> mesh = indexMember(node, "mesh")) ++shown[*mesh];
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
  Json& meshes = asset_.json()["meshes"];
  Json copy = meshes[group.mesh];
  meshes.push_back(std::move(copy));
  return static_cast<Index>(meshes.size() - 1);
}

Index SkinnedNodes::addSkin(const SkinJoints& joints, const Affine& toWorld) {
  const auto [known, isNew] = skins_.try_emplace({joints.nodes, numbersOf(toWorld)}, 0);
  if (!isNew) return known->second;

  std::vector<float> inverseBinds;
  inverseBinds.reserve(16 * joints.toJoint.size());
  for (const Affine& toJoint : joints.toJoint) {
    const Mat4 matrix = (toJoint * toWorld).matrix();
    for (int i = 0; i < 16; ++i) inverseBinds.push_back(static_cast<float>(matrix(i % 4, i / 4)));
  }
  if (!std::all_of(inverseBinds.begin(), inverseBinds.end(), [](float x) { return std::isfinite(x); })) {
    throw Error(ErrorCode::kBadData, "has inverse bind matrices that are not finite", "skin '" + joints.name + "'",
                "the model lies too far from the origin or is scaled too much");
  }
  const Index accessor = addFloatAccessor(asset_, inverseBinds, 16);
  Json skin = Json::object();
  if (!joints.name.empty()) skin["name"] = joints.name;
  skin["inverseBindMatrices"] = accessor;
  if (joints.skeleton) skin["skeleton"] = *joints.skeleton;
  skin["joints"] = joints.nodes;
  Json& skins = asset_.json()["skins"];
  skins.push_back(std::move(skin));
  return known->second = static_cast<Index>(skins.size() - 1);
}

// Can the node show a mesh that is in world space already?
bool SkinnedNodes::standsAtOrigin(const MeshGroup& group) const {
  const Json& node = elements(asset_, "nodes")[group.node];
  if (graph_.parent[group.node] || group.copy > 0) return false;
  if (const Json* extensions = member(node, "extensions"); extensions && extensions->contains(kInstancing))
    return false;
  return !node.contains("matrix") && !node.contains("translation") && !node.contains("rotation") &&
         !node.contains("scale");
}

bool SkinnedNodes::loosesAnimation(Index node) const {
  for (std::optional<Index> n = node; n && !carries_[*n]; n = graph_.parent[*n]) {
    if (animated_[*n]) return true;
  }
  return false;
}

// Hands the group's mesh, with its morph weights and their animation, to a new node without a parent.
Index SkinnedNodes::moveToRoot(const MeshGroup& group, const char* suffix) {
  Json& nodes = asset_.json()["nodes"];
  const auto moved = static_cast<Index>(nodes.size());
  Json node = Json::object();
  std::string name = nameOf(nodes[group.node]);
  if (name.empty()) name = nameOf(elements(asset_, "meshes")[group.mesh]);
  if (!name.empty()) node["name"] = names_.add(name + suffix);
  if (const Json* weights = member(nodes[group.node], "weights")) node["weights"] = *weights;
  nodes.push_back(std::move(node));

  if (group.copy == 0) retargetMorphChannels(asset_, group.node, moved);
  for (const Index scene : scenesOf_[group.node]) asset_.json()["scenes"][scene]["nodes"].push_back(moved);
  return moved;
}

void SkinnedNodes::place(const MeshGroup& group, Index mesh, Index skin) {
  const bool wasSkinned = elements(asset_, "nodes")[group.node].contains("skin");  // then it stays as the file has it
  if (!wasSkinned && group.copy == 0 && loosesAnimation(group.node)) ++lostAnimations_;
  const bool stays = wasSkinned || standsAtOrigin(group);
  const Index node = stays ? group.node : moveToRoot(group, "_skinned");
  Json& shown = asset_.json()["nodes"][node];
  shown["mesh"] = mesh;
  shown["skin"] = skin;
  if (!stays) takeMeshOff(group);
}

void SkinnedNodes::placeStatic(const MeshGroup& group, Index mesh) {
  const bool stays = standsAtOrigin(group);
  const Index node = stays ? group.node : moveToRoot(group, "_posed");
  Json& shown = asset_.json()["nodes"][node];
  shown["mesh"] = mesh;
  shown.erase("skin");
  shown.erase("weights");
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
  Json& old = asset_.json()["nodes"][group.node];
  old.erase("mesh");
  old.erase("skin");
  old.erase("weights");
  if (eraseExtension(old, kInstancing)) ++expandedInstances_;
}

void SkinnedNodes::showInScenes(Index root) {
  std::set<Index> scenes;
  for (const MeshGroup& group : groups_) scenes.insert(scenesOf_[group.node].begin(), scenesOf_[group.node].end());
  for (const Index scene : scenes) asset_.json()["scenes"][scene]["nodes"].push_back(root);
}

void SkinnedNodes::finish() {
  asset_.warnings.add("node-animation", "meshes are moved by an animation of their node, which no longer moves them",
                      {}, lostAnimations_);
  asset_.warnings.add("expanded-instances", "GPU instances are written as meshes of their own, since these cannot bend",
                      {}, expandedInstances_);
  if (expandedInstances_ == 0) return;
  const Json& nodes = elements(asset_, "nodes");
  const bool used = std::any_of(nodes.begin(), nodes.end(), [](const Json& node) {
    const Json* extensions = member(node, "extensions");
    return extensions && extensions->contains(kInstancing);
  });
  if (used) return;
  undeclareExtension(asset_.json(), kInstancing);
}

}  // namespace limber
