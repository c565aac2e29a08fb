// Skins are placed one after the other in file order, each walk over the tree amortised: the cost is linear in nodes
// and joints whatever a hostile file nests.
#include "limber/document/rig/bind_pose.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {

SkinBinding readSkinBinding(const Asset& asset, Index skin) {
  const gltf::Skin& source = asset.document.skins[skin];
  SkinBinding binding;
  binding.joints = source.joints;
  binding.inverseBinds.assign(binding.joints.size(), Affine::Identity());
  if (!source.inverseBindMatrices) return binding;

  const std::vector<float> values = readFloats(asset, *source.inverseBindMatrices);
  binding.given = true;
  for (std::size_t j = 0; j < binding.joints.size() && 16 * (j + 1) <= values.size(); ++j) {
    const Eigen::Map<const Eigen::Matrix4f> matrix(values.data() + 16 * j);
    binding.inverseBinds[j].matrix() = matrix.cast<double>();
    binding.inverseBinds[j].makeAffine();
  }
  return binding;
}

namespace {

constexpr double kSamePlacement = 1e-3;     // relative: poses that differ less are one (files store single precision)
constexpr std::size_t kMaxCandidates = 64;  // placements compared for one skin

std::optional<Affine> inverseOf(const Affine& affine) {
  const Affine inverse = affine.inverse(Eigen::Affine);
  if (!inverse.matrix().allFinite()) return std::nullopt;
  return inverse;
}

// Is one placement a rigid motion of the other, up to a hundredth in scale?
bool sameScale(const Affine& a, const Affine& b) {
  const double va = a.linear().determinant(), vb = b.linear().determinant();
  return va * vb > 0 && std::abs(std::cbrt(va / vb) - 1) < 0.01;
}

// Positions the skins of one document.
class BindPoseBuilder {
 public:
  BindPoseBuilder(const Asset& asset, const SceneGraph& graph) : asset_(asset), graph_(graph) {
    bind_.resize(graph.nodeCount());
    placedBelow_.resize(graph.nodeCount());
    pose_.skinToWorld.assign(asset.document.skins.size(), Affine::Identity());
    pose_.isJoint.assign(graph.nodeCount(), false);
  }

  BindPose build() {
    findSkins();
    for (std::size_t i = 0; i < pose_.skins.size(); ++i) placeSkin(pose_.skins[i], skinNodes_[i]);
    placeNodes();
    return std::move(pose_);
  }

 private:
  void findSkins() {
    std::vector<bool> met(pose_.skinToWorld.size(), false);
    for (const Index n : graph_.order) {
      const gltf::Node& node = asset_.document.nodes[n];
      if (!node.skin || !node.mesh || met[*node.skin]) continue;
      met[*node.skin] = true;
      pose_.skins.push_back(*node.skin);
      skinNodes_.push_back(n);
    }
    if (!pose_.skins.empty()) return;
    for (Index skin = 0; skin < met.size(); ++skin) pose_.skins.push_back(skin);
    skinNodes_.resize(pose_.skins.size());
  }

  void placeSkin(Index skin, std::optional<Index> meshNode) {
    const SkinBinding binding = readSkinBinding(asset_, skin);
    std::optional<Affine> toWorld = placementByNeighbours(binding);
    if (!toWorld) toWorld = placementByNodes(binding, meshNode);
    pose_.skinToWorld[skin] = *toWorld;
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      const Index node = binding.joints[j];
      pose_.isJoint[node] = true;
      if (bind_[node]) continue;
      const std::optional<Affine> jointToMesh =
          binding.given ? inverseOf(binding.inverseBinds[j]) : std::optional<Affine>();
      bind_[node] = jointToMesh ? *toWorld * *jointToMesh : graph_.world[node];
      for (Index n = node; graph_.parent[n] && !placedBelow_[*graph_.parent[n]]; n = *graph_.parent[n]) {
        placedBelow_[*graph_.parent[n]] = node;
      }
    }
  }

  // The placement that makes the skin meet the joints placed before it, if it is related to any: a joint in common,
  // else one above, else one below.
  std::optional<Affine> placementByNeighbours(const SkinBinding& binding) const {
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      if (const auto& bind = bind_[binding.joints[j]]) return *bind * binding.inverseBinds[j];
    }
    std::vector<bool> walked(graph_.nodeCount(), false);
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      Affine relative = Affine::Identity();  // joint -> the node that the walk is at
      for (std::optional<Index> n = binding.joints[j]; n && !walked[*n]; n = graph_.parent[*n]) {
        if (bind_[*n]) return *bind_[*n] * relative * binding.inverseBinds[j];
        walked[*n] = true;
        relative = graph_.local[*n] * relative;
      }
    }
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      if (const auto below = placedBelow_[binding.joints[j]]) {
        const std::optional<Affine> toJoint = inverseOf(graph_.world[*below]);
        if (toJoint) return *bind_[*below] * *toJoint * graph_.world[binding.joints[j]] * binding.inverseBinds[j];
      }
    }
    return std::nullopt;
  }

  // The placement by the nodes as the file stores them. Joint j says world_j * inverseBind_j; in a file that stores the
  // bind pose all joints say the same.
  Affine placementByNodes(const SkinBinding& binding, std::optional<Index> meshNode) const {
    std::vector<Affine> candidates;
    for (std::size_t j = 0; j < binding.joints.size() && candidates.size() < kMaxCandidates; ++j) {
      const Affine candidate = graph_.world[binding.joints[j]] * binding.inverseBinds[j];
      if (candidate.matrix().allFinite()) candidates.push_back(candidate);
    }
    if (candidates.empty()) return Affine::Identity();
    std::size_t best = 0, bestVotes = 0;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const auto votes =
          static_cast<std::size_t>(std::count_if(candidates.begin(), candidates.end(), [&](const Affine& c) {
            return samePlacement(candidates[i], c, kSamePlacement);
          }));
      if (votes > bestVotes) {
        best = i;
        bestVotes = votes;
      }
    }
    const bool posed = binding.given && bestVotes < candidates.size();
    if (posed && meshNode && sameScale(graph_.world[*meshNode], candidates[best])) return graph_.world[*meshNode];
    return candidates[best];
  }

  void placeNodes() {
    pose_.nodeWorld = graph_.world;
    for (const Index n : graph_.allNodes) {
      if (bind_[n]) {
        pose_.nodeWorld[n] = *bind_[n];
      } else if (graph_.parent[n]) {
        pose_.nodeWorld[n] = pose_.nodeWorld[*graph_.parent[n]] * graph_.local[n];
      }
    }
  }

  const Asset& asset_;
  const SceneGraph& graph_;
  BindPose pose_;
  std::vector<std::optional<Index>> skinNodes_;    // the first mesh node that shows each of pose_.skins
  std::vector<std::optional<Affine>> bind_;        // #nodes, of the joints placed so far
  std::vector<std::optional<Index>> placedBelow_;  // #nodes, a placed joint below
};

}  // namespace

bool samePlacement(const Affine& a, const Affine& b, double tolerance) {
  const double size = std::max(a.linear().cwiseAbs().maxCoeff(), b.linear().cwiseAbs().maxCoeff());
  const double reach = std::max({size, a.translation().norm(), b.translation().norm()});
  return (a.linear() - b.linear()).cwiseAbs().maxCoeff() <= tolerance * size &&
         (a.translation() - b.translation()).cwiseAbs().maxCoeff() <= tolerance * reach;
}

BindPose readBindPose(const Asset& asset, const SceneGraph& graph) {
  return BindPoseBuilder(asset, graph).build();
}

namespace {

// The joints, as numbers of a skin's list, that a mesh has weights for.
std::set<Index> weightedJoints(const Asset& asset, Index mesh) {
  std::set<Index> joints;
  for (const gltf::Primitive& primitive : asset.document.meshes[mesh].primitives) {
    for (const InfluenceSet& set : readInfluenceSets(asset, primitive)) {
      for (std::size_t i = 0; i < set.weights.size(); ++i) {
        if (set.weights[i] > 0) joints.insert(set.joints[i]);
      }
    }
  }
  return joints;
}

}  // namespace

std::vector<Index> skinsBoundElsewhere(const Asset& asset, const BindPose& pose) {
  std::map<Index, std::set<Index>> elsewhere;  // by skin, of its joints
  for (const Index skin : pose.skins) {
    const SkinBinding binding = readSkinBinding(asset, skin);
    for (Index j = 0; j < binding.joints.size(); ++j) {
      const Affine placement = pose.nodeWorld[binding.joints[j]] * binding.inverseBinds[j];
      if (!samePlacement(placement, pose.skinToWorld[skin], kSamePlacement)) elsewhere[skin].insert(j);
    }
  }
  std::vector<bool> counts(asset.document.skins.size(), false);
  std::map<Index, std::set<Index>> weighted;  // by mesh
  for (const gltf::Node& node : asset.document.nodes) {
    if (!node.skin || !node.mesh || elsewhere.count(*node.skin) == 0 || counts[*node.skin]) continue;
    const auto [known, isNew] = weighted.try_emplace(*node.mesh);
    if (isNew) known->second = weightedJoints(asset, *node.mesh);
    const std::set<Index>&off = elsewhere[*node.skin], &has = known->second;
    counts[*node.skin] = std::any_of(off.begin(), off.end(), [&](Index joint) { return has.count(joint) > 0; });
  }
  std::vector<Index> result;
  std::copy_if(pose.skins.begin(), pose.skins.end(), std::back_inserter(result), [&](Index s) { return counts[s]; });
  return result;
}

}  // namespace limber
