// The skeleton and the weights that a document has.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/joint_radius.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/unique_names.h"

namespace limber {

bool hasRig(const Asset& asset) {
  const std::vector<gltf::Node>& nodes = asset.document.nodes;
  return std::any_of(nodes.begin(), nodes.end(), [](const gltf::Node& node) { return node.skin.has_value(); });
}

namespace {

constexpr Index kMaxSlots = 8;

// Joints, and the nodes that have a joint above and a joint below.
std::vector<bool> skeletonNodes(const SceneGraph& graph, const std::vector<bool>& isJoint) {
  std::vector<bool> above(graph.nodeCount(), false), below(isJoint);
  for (const Index n : graph.allNodes) {
    if (graph.parent[n]) above[n] = above[*graph.parent[n]] || isJoint[*graph.parent[n]];
  }
  for (auto n = graph.allNodes.rbegin(); n != graph.allNodes.rend(); ++n) {
    if (graph.parent[*n] && below[*n]) below[*graph.parent[*n]] = true;
  }
  std::vector<bool> result(isJoint);
  for (Index n = 0; n < graph.nodeCount(); ++n) result[n] = isJoint[n] || (above[n] && below[n]);
  return result;
}

// The rest transform that brings a joint to `bind` below a parent at `parent`; the node's own if none exists.
Transform restTransform(const Affine& parent, const Affine& bind, const Affine& stored) {
  const Affine local = parent.inverse(Eigen::Affine) * bind;
  if (local.matrix().allFinite()) return decompose(local);
  return stored.matrix().allFinite() ? decompose(stored) : Transform();
}

}  // namespace

AssetSkeleton readSkeleton(const Asset& asset) {
  const SceneGraph graph = readSceneGraph(asset.document);
  const BindPose pose = readBindPose(asset, graph);
  const std::vector<bool> wanted = skeletonNodes(graph, pose.isJoint);
  const std::vector<gltf::Node>& nodes = asset.document.nodes;
  const std::vector<std::string_view> declared = declaredBoneOfNode(asset.document);

  AssetSkeleton result;
  UniqueNames names;
  std::vector<std::optional<Index>> jointOfNode(graph.nodeCount());
  std::vector<Affine> globals;  // as the rest transforms rebuild them, so that errors do not add up along a chain
  bool allRadii = true;
  for (const Index n : graph.allNodes) {
    if (!wanted[n]) continue;
    Joint joint;
    const std::string& name = nodes[n].name;
    joint.name = names.add(name.empty() ? fmt::format("joint_{}", n) : name);
    if (graph.parent[n]) joint.parent = jointOfNode[*graph.parent[n]];
    const Affine above = joint.parent ? globals[*joint.parent] : Affine::Identity();
    joint.rest = restTransform(above, pose.nodeWorld[n], graph.local[n]);
    const std::optional<double> radius = storedRadius(nodes[n]);
    joint.radius = radius.value_or(0);
    joint.declaredBone = declared[n];
    allRadii = allRadii && radius;
    globals.push_back(above * joint.rest.toAffine());
    jointOfNode[n] = result.skeleton.jointCount();
    result.jointNode.push_back(n);
    result.skeleton.joints.push_back(std::move(joint));
  }
  // Only limber's own handle rigs say how thick the model is at every joint.
  if (allRadii && !result.jointNode.empty()) result.skeleton.boneShape = BoneShape::kSphere;
  return result;
}

namespace {

struct JointInfluence {
  Index joint;
  float weight;
};

// Adds to the influence of the same joint, if there is one.
void addInfluence(std::vector<JointInfluence>& influences, JointInfluence added) {
  const auto same = std::find_if(influences.begin(), influences.end(),
                                 [&](const JointInfluence& known) { return known.joint == added.joint; });
  if (same != influences.end()) {
    same->weight += added.weight;
  } else {
    influences.push_back(added);
  }
}

// Fills the weights of one document, instance by instance.
class WeightReader {
 public:
  WeightReader(const Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton)
      : asset_(asset), nodes_(asset.document.nodes), graph_(readSceneGraph(asset.document)), geometry_(geometry) {
    jointOfNode_.resize(graph_.nodeCount());
    for (Index j = 0; j < skeleton.jointNode.size(); ++j) jointOfNode_[skeleton.jointNode[j]] = j;
  }

  SkinWeights read() {
    result_.slots = 4;
    for (const PrimitiveInstance& instance : geometry_.instances) {
      if (nodes_[instance.node].skin && primitiveOf(instance).attributes.find("JOINTS_1")) {
        result_.slots = kMaxSlots;
      }
    }
    result_.joints.assign(geometry_.positions.size() * result_.slots, 0);
    result_.weights.assign(geometry_.positions.size() * result_.slots, 0.0f);
    for (const PrimitiveInstance& instance : geometry_.instances) {
      if (const std::optional<Index> skin = nodes_[instance.node].skin) {
        readSkinned(instance, *skin);
      } else {
        readRigid(instance);
      }
    }
    return std::move(result_);
  }

 private:
  const gltf::Primitive& primitiveOf(const PrimitiveInstance& instance) const {
    return asset_.document.meshes[instance.mesh].primitives[instance.primitive];
  }

  void readSkinned(const PrimitiveInstance& instance, Index skin) {
    const std::vector<InfluenceSet> sets = readInfluenceSets(asset_, primitiveOf(instance));
    const std::vector<Index> skinJoints = readSkinBinding(asset_, skin).joints;
    std::vector<JointInfluence> influences;
    for (std::size_t v = 0; v < instance.vertexCount; ++v) {
      influences.clear();
      for (const InfluenceSet& set : sets) {
        for (std::size_t i = 4 * v; i < 4 * v + 4 && i < set.weights.size(); ++i) {
          if (!(set.weights[i] > 0) || !std::isfinite(set.weights[i]) || set.joints[i] >= skinJoints.size()) continue;
          if (const auto joint = jointOfNode_[skinJoints[set.joints[i]]]) {
            addInfluence(influences, {*joint, set.weights[i]});
          }
        }
      }
      std::stable_sort(influences.begin(), influences.end(),
                       [](const JointInfluence& a, const JointInfluence& b) { return a.weight > b.weight; });
      store(instance.firstVertex + v, influences);
    }
  }

  void readRigid(const PrimitiveInstance& instance) {
    std::optional<Index> node = instance.node;
    while (node && !jointOfNode_[*node]) node = graph_.parent[*node];
    if (!node) return;
    const std::vector<JointInfluence> whole = {{*jointOfNode_[*node], 1.0f}};
    for (std::size_t v = 0; v < instance.vertexCount; ++v) store(instance.firstVertex + v, whole);
  }

  void store(std::size_t vertex, const std::vector<JointInfluence>& influences) {
    for (std::size_t i = 0; i < std::min<std::size_t>(result_.slots, influences.size()); ++i) {
      result_.joints[vertex * result_.slots + i] = influences[i].joint;
      result_.weights[vertex * result_.slots + i] = influences[i].weight;
    }
  }

  const Asset& asset_;
  const std::vector<gltf::Node>& nodes_;
  SceneGraph graph_;
  const Geometry& geometry_;
  std::vector<std::optional<Index>> jointOfNode_;
  SkinWeights result_;
};

}  // namespace

SkinWeights readWeights(const Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton) {
  return WeightReader(asset, geometry, skeleton).read();
}

}  // namespace limber
