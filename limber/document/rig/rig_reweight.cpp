// New weights for the skeleton that a document has.
#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/rig/skinned_nodes.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {

namespace {

class Reweighter {
 public:
  Reweighter(Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton, const SkinWeights& weights)
      : asset_(asset),
        geometry_(geometry),
        skeleton_(skeleton),
        weights_(weights),
        graph_(readSceneGraph(asset.document)) {
    pose_ = readBindPose(asset, graph_);
    for (const Index node : skeleton.jointNode) toJoint_.push_back(inverseBindOf(node));
  }

  void run() {
    std::vector<bool> carries(graph_.nodeCount(), false);
    for (const Index node : skeleton_.jointNode) carries[node] = true;
    SkinnedNodes skinned(asset_, geometry_, std::move(carries));
    extendSkins(skinned.groups());
    for (const MeshGroup& group : skinned.groups()) reweight(skinned, group);
    skinned.finish();
    joinTrees();
  }

 private:
  Affine inverseBindOf(Index node) const {
    const Affine toJoint = pose_.nodeWorld[node].inverse(Eigen::Affine);
    if (toJoint.matrix().allFinite()) return toJoint;
    throw Error(ErrorCode::kBadData, "has a bind pose without an inverse", fmt::format("nodes[{}]", node),
                "replace the rig");
  }

  std::optional<Index> skinOf(const MeshGroup& group) const { return asset_.document.nodes[group.node].skin; }

  // The joints that the new weights of a group name, ascending.
  std::set<Index> usedJoints(const MeshGroup& group) const {
    std::vector<bool> used(skeleton_.jointNode.size(), false);
    for (Index i = group.firstInstance; i < group.endInstance; ++i) {
      const PrimitiveInstance& instance = geometry_.instances[i];
      for (Index v = instance.firstVertex; v < instance.firstVertex + instance.vertexCount; ++v) {
        for (Index slot = 0; slot < weights_.slots; ++slot) {
          if (weights_.weightsOf(v)[slot] > 0) used.at(weights_.jointsOf(v)[slot]) = true;
        }
      }
    }
    std::set<Index> result;
    for (Index j = 0; j < used.size(); ++j) {
      if (used[j]) result.insert(j);
    }
    return result;
  }

  // Appends to each skin the joints that its meshes now need and it lacks. What it has stays as it is, to the bit.
  void extendSkins(const std::vector<MeshGroup>& groups) {
    std::map<Index, std::set<Index>> needed;
    for (const MeshGroup& group : groups) {
      const std::optional<Index> skin = skinOf(group);
      if (skin) needed[*skin].merge(usedJoints(group));
    }
    for (const auto& [skin, joints] : needed) extendSkin(skin, joints);
  }

  void extendSkin(Index skin, const std::set<Index>& needed) {
    const SkinBinding binding = readSkinBinding(asset_, skin);
    std::vector<Index> nodes = binding.joints;
    const std::vector<Index> skinJointOfNode = inverted(binding.joints);
    for (const Index joint : needed) {
      const Index node = skeleton_.jointNode[joint];
      if (skinJointOfNode[node] == kNoIndex) nodes.push_back(node);
    }
    if (nodes.size() > kMaxSkinJoints) {
      throw Error(ErrorCode::kLimit, fmt::format("needs {} joints", nodes.size()), fmt::format("skins[{}]", skin));
    }
    checkSkeletonRoot(skin, binding.joints.size(), nodes);
    if (binding.given && nodes.size() == binding.joints.size()) return;

    std::vector<float> inverseBinds;
    if (binding.given) {
      inverseBinds = readFloats(asset_, *asset_.document.skins[skin].inverseBindMatrices);
      inverseBinds.resize(16 * binding.joints.size());
    } else {
      asset_.warnings.add("missing-inverse-binds", "skins without inverse bind matrices are given them");
    }
    for (std::size_t j = inverseBinds.size() / 16; j < nodes.size(); ++j) {
      appendMatrix(inverseBindOf(nodes[j]) * pose_.skinToWorld[skin], inverseBinds);
    }
    gltf::Skin& target = asset_.document.skins[skin];
    target.inverseBindMatrices = addFloatAccessor(asset_, inverseBinds, 16);
    target.joints = nodes;
    touched_.push_back(skin);
  }

  // "skeleton" is optional, and wrong where it is not above all joints: of the first `old` of them because the file
  // says so, of the others because they are new.
  void checkSkeletonRoot(Index skin, std::size_t old, const std::vector<Index>& nodes) {
    std::optional<Index>& root = asset_.document.skins[skin].skeleton;
    if (!root) return;
    const auto outside =
        std::find_if(nodes.begin(), nodes.end(), [&](Index node) { return !isAtOrBelow(node, *root); });
    if (outside == nodes.end()) return;
    root.reset();
    if (outside >= nodes.begin() + static_cast<std::ptrdiff_t>(old)) return;
    asset_.warnings.add("skeleton-root",
                        "skins name a skeleton root that is not above their joints: the name is left out",
                        fmt::format("skins[{}]", skin));
  }

  bool isAtOrBelow(Index node, Index root) const {
    std::optional<Index> n = node;
    while (n && *n != root) n = graph_.parent[*n];
    return n.has_value();
  }

  // Node -> its index in `joints`, kNoIndex where it is not there.
  std::vector<Index> inverted(const std::vector<Index>& joints) const {
    std::vector<Index> result(graph_.nodeCount(), kNoIndex);
    for (Index j = 0; j < joints.size(); ++j) result[joints[j]] = j;
    return result;
  }

  void reweight(SkinnedNodes& skinned, const MeshGroup& group) {
    std::optional<Index> skin = skinOf(group);
    if (!skin) skin = skinForRigidPart(skinned, group);
    const std::vector<Index> nodes = readSkinBinding(asset_, *skin).joints;
    const std::vector<Index> skinJointOfNode = inverted(nodes);
    std::vector<Index> skinJointOf;
    for (const Index node : skeleton_.jointNode) skinJointOf.push_back(skinJointOfNode[node]);
    const Index mesh = skinned.meshFor(group);
    for (Index i = group.firstInstance; i < group.endInstance; ++i) {
      const PrimitiveInstance& instance = geometry_.instances[i];
      writeWeightAttributes(asset_, {mesh, instance.primitive}, instance, weights_, skinJointOf,
                            static_cast<Index>(nodes.size()));
    }
    skinned.attach(group, mesh, *skin);
  }

  // A part that hung on a joint gets a skin of its own, with just the joints that it needs.
  Index skinForRigidPart(SkinnedNodes& skinned, const MeshGroup& group) {
    SkinJoints joints;
    joints.name = asset_.document.nodes[group.node].name;
    for (const Index joint : usedJoints(group)) {
      joints.nodes.push_back(skeleton_.jointNode[joint]);
      joints.toJoint.push_back(toJoint_[joint]);
    }
    const Index skin = skinned.addSkin(joints, group.toWorld);
    touched_.push_back(skin);
    return skin;
  }

  // The joints of one skin must have a node above them all. Where skins of several trees now share joints, and only
  // there, a new root takes the roots of these trees as its children.
  void joinTrees() {
    std::set<Index> roots;
    for (const Index skin : touched_) {
      std::set<Index> ofSkin;
      for (Index node : readSkinBinding(asset_, skin).joints) {
        while (graph_.parent[node]) node = *graph_.parent[node];
        ofSkin.insert(node);
      }
      if (ofSkin.size() > 1) roots.merge(ofSkin);
    }
    if (roots.empty()) return;

    gltf::Node above;
    above.name = "limber_common_root";
    above.children.assign(roots.begin(), roots.end());
    const Index common = addElement(asset_.document.nodes, std::move(above));
    for (gltf::Scene& scene : asset_.document.scenes) {
      const std::size_t joined = std::erase_if(scene.nodes, [&](Index node) { return roots.count(node) > 0; });
      if (joined > 0) scene.nodes.push_back(common);
    }
  }

  Asset& asset_;
  const Geometry& geometry_;
  const AssetSkeleton& skeleton_;
  const SkinWeights& weights_;
  SceneGraph graph_;
  BindPose pose_;
  std::vector<Affine> toJoint_;  // #J, world -> joint
  std::vector<Index> touched_;   // skins made or extended here
};

bool isSkinned(const PrimitiveInstance& part, const SkinWeights& weights) {
  const std::span<const float> all = weights.weights;
  const std::span<const float> own =
      all.subspan(std::size_t{part.firstVertex} * weights.slots, std::size_t{part.vertexCount} * weights.slots);
  return std::any_of(own.begin(), own.end(), [](float weight) { return weight > 0; });
}

// The parts of the nodes that show anything that a joint holds; the vertices themselves are not needed.
Geometry skinnedParts(const Geometry& geometry, const SkinWeights& weights) {
  std::set<std::pair<Index, Index>> skinned;
  for (const PrimitiveInstance& part : geometry.instances) {
    if (isSkinned(part, weights)) skinned.insert({part.node, part.copy});
  }
  Geometry result;
  for (const PrimitiveInstance& part : geometry.instances) {
    if (skinned.count({part.node, part.copy}) > 0) result.instances.push_back(part);
  }
  return result;
}

}  // namespace

void replaceWeights(Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton, const SkinWeights& weights) {
  if (weights.vertexCount() != geometry.positions.size() ||
      skeleton.jointNode.size() != skeleton.skeleton.joints.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("weights for {} vertices, but the geometry has {}",
                                                     weights.vertexCount(), geometry.positions.size()));
  }
  for (const Index joint : weights.joints) {
    if (joint >= skeleton.jointNode.size()) {
      throw Error(ErrorCode::kBadArgument,
                  fmt::format("weights name joint {} of {}", joint, skeleton.jointNode.size()));
    }
  }
  const AccessorSweep unused(asset);
  const Geometry skinned = skinnedParts(geometry, weights);
  Reweighter(asset, skinned, skeleton, weights).run();
  unused.sweep(asset);
}

}  // namespace limber
