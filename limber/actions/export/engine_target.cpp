#include "limber/actions/export/engine_target.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/actions/export/joint_frames.h"
#include "limber/actions/export/target_names.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/core/text/names.h"
#include "limber/core/transform.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/rig/root_joint.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

constexpr double kSameScale = 1e-6;  // relative: of one frame's three scales

constexpr std::array kTargets = {
    EngineTarget{kPlainTarget, "as it is", BoneNames::kVrm, NameStyle::kCamel, "", BoneAxes::kAsTheyAre,
                 FbxUnit::kCentimetre},
    EngineTarget{"unreal", "the names, root and axes of Unreal Engine 5's mannequin", BoneNames::kUnreal,
                 NameStyle::kSnake, "root", BoneAxes::kUnreal, FbxUnit::kCentimetre},
    EngineTarget{"unity", "the names of Unity's humanoid avatar, and a root", BoneNames::kUnity, NameStyle::kPascal,
                 "Root", BoneAxes::kAsTheyAre, FbxUnit::kCentimetre},
    EngineTarget{"godot", "the names, root and axes of Godot's SkeletonProfileHumanoid", BoneNames::kGodot,
                 NameStyle::kPascal, "Root", BoneAxes::kAlongY, FbxUnit::kMetre},
    EngineTarget{"blender", "names with .L and .R that Blender mirrors, y along bones", BoneNames::kBlender,
                 NameStyle::kDotted, "", BoneAxes::kAlongY, FbxUnit::kCentimetre},
    EngineTarget{"vrm", "the names of VRM 1.0's bones", BoneNames::kVrm, NameStyle::kCamel, "", BoneAxes::kAsTheyAre,
                 FbxUnit::kMetre},
    EngineTarget{"mixamo", "the names of Mixamo's characters", BoneNames::kMixamo, NameStyle::kMixamo, "",
                 BoneAxes::kAsTheyAre, FbxUnit::kCentimetre},
    EngineTarget{"metahuman", "Unreal's names, root and axes, the spine up to MetaHuman's spine_05",
                 BoneNames::kMetaHuman, NameStyle::kSnake, "root", BoneAxes::kUnreal, FbxUnit::kCentimetre},
    EngineTarget{"rigify", "the names of deform bones of Blender's Rigify, y along bones", BoneNames::kRigify,
                 NameStyle::kRigify, "", BoneAxes::kAlongY, FbxUnit::kCentimetre},
    EngineTarget{"actorcore", "the names and root of ActorCore, AccuRig and Character Creator", BoneNames::kActorCore,
                 NameStyle::kActorCore, "RL_BoneRoot", BoneAxes::kAsTheyAre, FbxUnit::kCentimetre},
    EngineTarget{"roblox", "the names and root of Roblox's R15 characters", BoneNames::kRoblox, NameStyle::kPascal,
                 "Root", BoneAxes::kAsTheyAre, FbxUnit::kMetre},
};

// The rotation by quarters of a turn that is nearest to one.
Quat nearestByQuarters(const Quat& turn) {
  const Mat3 matrix = turn.toRotationMatrix();
  Mat3 nearest = Mat3::Identity();
  double most = -4;
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Mat3 axes = Mat3::Zero();
      for (int i = 0; i < 3; ++i) axes(order[static_cast<std::size_t>(i)], i) = (signs >> i & 1) != 0 ? -1 : 1;
      if (axes.determinant() < 0) continue;
      const double likeness = axes.cwiseProduct(matrix).sum();
      if (likeness > most + 1e-9) std::tie(most, nearest) = std::pair(likeness, axes);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return Quat(nearest);
}

const Json* member(const Json* json, const char* name) {
  if (json == nullptr || !json->is_object()) return nullptr;
  const auto found = json->find(name);
  return found == json->end() ? nullptr : &*found;
}

// The node whose number is that member.
std::optional<Index> nodeIn(const Json* json, const char* name, const gltf::Document& document) {
  const Json* node = member(json, name);
  if (node == nullptr || !node->is_number_unsigned() || node->get<std::uint64_t>() >= document.nodeCount()) {
    return std::nullopt;
  }
  return node->get<Index>();
}

// The nodes that `list` names by the member "node".
void addNodesOf(const Json* list, const gltf::Document& document, std::set<Index>& nodes) {
  if (list == nullptr || !list->is_array()) return;
  for (const Json& entry : *list) {
    if (const std::optional<Index> node = nodeIn(&entry, "node", document)) nodes.insert(*node);
  }
}

// A node of VRM that turns as another one does, its source: by as much in its own axes as that one in its own, or as
// seen from what each of them hangs on ("roll").
void addConstraint(const gltf::Document& document, const SceneGraph& graph, Index turned, std::set<Index>& nodes) {
  const Json* constraint = member(member(&*document.nodes[turned].extensions, "VRMC_node_constraint"), "constraint");
  if (const auto source = nodeIn(member(constraint, "rotation"), "source", document)) nodes.insert(*source);
  const auto source = nodeIn(member(constraint, "roll"), "source", document);
  if (!source || graph.parent[*source] == graph.parent[turned]) return;
  for (const Index node : {*source, turned}) {
    if (graph.parent[node]) nodes.insert(*graph.parent[node]);
  }
}

// Nodes in whose own axes something is given: their contents, colliders of springs, constraints, the eyes' position.
std::set<Index> nodesThatKeepAxes(const gltf::Document& document, const SceneGraph& graph) {
  std::set<Index> nodes;
  for (Index n = 0; n < document.nodeCount(); ++n) {
    const gltf::Node& node = document.nodes[n];
    if ((node.mesh && !node.skin) || node.camera || node.extensions.exists()) nodes.insert(n);
    if (node.extensions.exists()) addConstraint(document, graph, n, nodes);
  }
  for (const char* extension : {kVrmName, kVrm0Name}) {
    for (const HumanoidNode& bone : humanoidNodes(document, extension)) {
      if (bone.bone == "head") nodes.insert(bone.node);
    }
  }
  if (!document.extensions.exists()) return nodes;
  const Json& extensions = *document.extensions;
  // Of a motion for VRMs the gaze begins at an offset from the head.
  if (member(member(&extensions, kVrmAnimationName), "lookAt") != nullptr) {
    for (const HumanoidNode& bone : humanoidNodes(document, kVrmAnimationName)) {
      if (bone.bone == "head") nodes.insert(bone.node);
    }
  }
  addNodesOf(member(member(&extensions, "VRMC_springBone"), "colliders"), document, nodes);
  addNodesOf(member(member(member(&extensions, "VRM"), "secondaryAnimation"), "colliderGroups"), document, nodes);
  return nodes;
}

bool isEven(const Affine& frame) {
  bool sheared = false;
  const Vec3 scale = decompose(frame, &sheared).scale;
  return !sheared && scale.minCoeff() > 0 && scale.maxCoeff() - scale.minCoeff() <= kSameScale * scale.maxCoeff();
}

// The scale with the same volume; 1 where that is none.
double evenScaleOf(const Affine& frame) {
  const double scale = std::cbrt(std::abs(frame.linear().determinant()));
  return scale > 0 && std::isfinite(scale) ? scale : 1;
}

class TargetMaker {
 public:
  TargetMaker(Asset& asset, const EngineTarget& target)
      : asset_(asset),
        target_(target),
        skeleton_(hasRig(asset) ? readSkeleton(asset) : movingSkeleton(asset)),
        globals_(restGlobals(skeleton_.skeleton)) {}

  void make(const SkeletonReading& known) {
    const SkeletonReading reading = known.of(skeleton_.skeleton);
    const Anatomy& anatomy = reading.anatomy();
    const std::vector<HumanoidJoint> bones = humanoidJoints(reading);
    const TargetNames names = targetNames(skeleton_.skeleton, anatomy, bones, target_.boneNames, target_.style);
    std::vector<Quat> turns;
    if (target_.axes != BoneAxes::kAsTheyAre) turns = boneTurns(skeleton_.skeleton, anatomy, bones, target_.axes);
    const bool wantsRoot = !target_.rootName.empty();
    if (wantsRoot) placeRoot();
    changeFrames(asset_, frameChanges(turns));
    rename(names);
    if (wantsRoot) deleteEmptyFrames();
  }

 private:
  // The root joint, which leaves the nodes above it where these stand still.
  void placeRoot() {
    if (const std::optional<Index> own = findRootJoint(asset_, skeleton_)) {
      root_ = skeleton_.jointNode[*own];
    } else {
      try {
        root_ = addRootJoint(asset_, std::string(target_.rootName)).jointNode.front();
      } catch (const Error& error) {
        if (error.code() != ErrorCode::kUnsupported) throw;
        asset_.warnings.add("no-root-joint", "the skeleton gets no root joint: a node " + error.message(),
                            error.where());
        return;
      }
    }
    const SceneGraph graph = readSceneGraph(asset_.document);
    rootScale_ = evenScaleOf(graph.world[*root_]);
    const std::optional<Index> parent = graph.parent[*root_];
    if (!parent || !isStationary(graph, *parent) || !isEven(graph.world[*parent])) return;
    aboveRoot_ = graph.world[*parent];
    Index top = *parent;
    while (graph.parent[top]) top = *graph.parent[top];
    std::erase(asset_.document.nodes[*parent].children, *root_);
    for (gltf::Scene& scene : asset_.document.scenes) {
      if (std::count(scene.nodes.begin(), scene.nodes.end(), top) > 0) scene.nodes.push_back(*root_);
    }
  }

  bool isStationary(const SceneGraph& graph, Index node) const {
    const std::vector<bool> animated = animatedNodes(asset_.document);
    for (std::optional<Index> n = node; n; n = graph.parent[*n]) {
      if (animated[*n]) return false;
    }
    return true;
  }

  std::vector<FrameChange> frameChanges(const std::vector<Quat>& turns) {
    const SceneGraph graph = readSceneGraph(asset_.document);
    const std::set<Index> keep = nodesThatKeepAxes(asset_.document, graph);
    const std::vector<bool> uneven = unevenlyScaled(asset_);
    std::vector<FrameChange> changes(graph.parent.size());
    std::size_t kept = 0;
    for (Index j = 0; j < skeleton_.skeleton.jointCount(); ++j) {
      const Index node = skeleton_.jointNode[j];
      if (keep.count(node) > 0) {
        if (!turns.empty()) ++kept;
        continue;
      }
      FrameChange& change = changes[node];
      if (root_) change.scale = 1 / evenScaleOf(globals_[j]);
      if (turns.empty()) continue;
      const Quat wanted = isRoot(node) ? Quat::Identity() : turns[j];
      change.turn = decompose(globals_[j]).rotation.conjugate() * wanted;
      if (!uneven[node]) continue;
      change.turn = nearestByQuarters(change.turn);
      ++kept;
    }
    if (kept > 0) {
      asset_.warnings.add("kept-axes", "joints keep axes that meshes, extensions or uneven scales depend on", {}, kept);
    }
    if (root_ && keep.count(*root_) == 0) changes[*root_].scale = 1 / rootScale_;
    for (Index n = 0; n < graph.nodeCount(); ++n) {
      if (const std::optional<Index> parent = graph.parent[n]; parent && !changes[*parent].isNone()) {
        const FrameChange& above = changes[*parent];
        changes[n].before = Affine(above.turn * Eigen::Scaling(above.scale)).inverse(Eigen::Affine);
      }
    }
    if (root_ && aboveRoot_) changes[*root_].before = *aboveRoot_;
    return changes;
  }

  bool isRoot(Index node) const { return root_ == node; }

  // Joints first; what else is called so gets a number. The tips that bones end in are spelled as joints are.
  void rename(const TargetNames& names) {
    std::vector<gltf::Node>& nodes = asset_.document.nodes;
    UniqueNames taken;
    std::set<Index> joints(skeleton_.jointNode.begin(), skeleton_.jointNode.end());
    if (root_) {
      joints.insert(*root_);
      nodes[*root_].name = taken.add(std::string(target_.rootName));
    }
    for (Index j = 0; j < names.joints.size(); ++j) {
      if (!isRoot(skeleton_.jointNode[j])) nodes[skeleton_.jointNode[j]].name = taken.add(names.joints[j]);
    }
    const SceneGraph graph = readSceneGraph(asset_.document);
    for (Index n = 0; n < nodes.size(); ++n) {
      if (joints.count(n) > 0 || nodes[n].name.empty()) continue;
      const bool isTip = graph.parent[n] && joints.count(*graph.parent[n]) > 0 && !nodes[n].mesh && !nodes[n].camera;
      const bool isRespelled = isTip && !names.isOwn;
      nodes[n].name = taken.add(isRespelled ? respelled(nodes[n].name, target_.style) : nodes[n].name);
    }
  }

  // Nodes that the roots hung on, and that hold nothing any more.
  void deleteEmptyFrames() {
    const SceneGraph graph = readSceneGraph(asset_.document);
    const std::vector<bool> animated = animatedNodes(asset_.document);
    std::vector<bool> keep(graph.parent.size(), true);
    for (const Index frame : framesAbove_) {
      const gltf::Node& node = asset_.document.nodes[frame];
      const bool isBare = !node.mesh && !node.camera && !node.skin && !node.extensions.exists() &&
                          !node.extras.exists() && !animated[frame];
      keep[frame] = !isBare || std::any_of(node.children.begin(), node.children.end(),
                                           [&](Index child) { return bool{keep[child]}; });
    }
    deleteNodes(asset_, keep);
  }

  static std::vector<Index> framesAbove(const Asset& asset, const AssetSkeleton& skeleton) {
    const SceneGraph graph = readSceneGraph(asset.document);
    const std::set<Index> joints(skeleton.jointNode.begin(), skeleton.jointNode.end());
    std::set<Index> above;
    for (const Index joint : skeleton.jointNode) {
      for (std::optional<Index> n = graph.parent[joint]; n; n = graph.parent[*n]) {
        if (joints.count(*n) == 0) above.insert(*n);
      }
    }
    std::vector<Index> ordered;  // children before parents
    for (auto n = graph.allNodes.rbegin(); n != graph.allNodes.rend(); ++n) {
      if (above.count(*n) > 0) ordered.push_back(*n);
    }
    return ordered;
  }

  Asset& asset_;
  const EngineTarget& target_;
  AssetSkeleton skeleton_;
  std::vector<Affine> globals_;  // #J
  std::vector<Index> framesAbove_ = framesAbove(asset_, skeleton_);
  std::optional<Index> root_;        // a node
  double rootScale_ = 1;             // in the world
  std::optional<Affine> aboveRoot_;  // the frame that the root was taken out of
};

}  // namespace

std::span<const EngineTarget> engineTargets() {
  return kTargets;
}

const EngineTarget& findTarget(std::string_view name) {
  return findByName(kTargets, "target", name);
}

void toTarget(Asset& asset, const EngineTarget& target, const SkeletonReading& known) {
  if (target.isPlain()) return;
  if (!hasRig(asset) && (!isSkeletonAlone(asset) || movingSkeleton(asset).jointNode.empty())) {
    asset.warnings.add("no-skeleton", "there is no skeleton, so no joint gets the target's name, root or axes");
    return;
  }
  const AccessorSweep unused(asset);
  TargetMaker(asset, target).make(known);
  unused.sweep(asset);
}

void toTarget(Motion& motion, const EngineTarget& target) {
  if (target.isPlain()) return;
  Asset asset = motionAsset(motion);  // takes the motion's warnings along
  toTarget(asset, target);
  Motion made = motionOf(asset);
  motion.skeleton = std::move(made.skeleton);
  motion.clips = std::move(made.clips);
  motion.warnings = std::move(made.warnings);
}

}  // namespace limber
