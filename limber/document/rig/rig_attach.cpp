// Puts a rig into a document: joint nodes, skins, and weights for every mesh that the scene shows.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/rig/joint_radius.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/rig/skinned_nodes.h"
#include "limber/document/rig/weight_attributes.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

constexpr const char* kRigName = "limber_rig";

Transform rounded(Transform t) {
  for (int i = 0; i < 3; ++i) t.translation[i] = shortDouble(t.translation[i]);
  for (int i = 0; i < 3; ++i) t.scale[i] = shortDouble(t.scale[i]);
  for (int i = 0; i < 4; ++i) t.rotation.coeffs()[i] = shortDouble(t.rotation.coeffs()[i]);
  return t;
}

gltf::Node jointNode(const Joint& joint, const Transform& rest, const std::string& name, bool withRadius) {
  gltf::Node node;
  node.name = name;
  node.translation = rest.translation;
  if (!rest.rotation.coeffs().isApprox(Quat::Identity().coeffs(), 0)) node.rotation = rest.rotation.coeffs();
  if (rest.scale != Vec3::Ones()) node.scale = rest.scale;
  if (withRadius) storeRadius(node, joint.radius);
  return node;
}

void checkArguments(const Asset& asset, const Geometry& geometry, const Skeleton& skeleton,
                    const SkinWeights& weights) {
  checkSkeleton(skeleton);
  if (skeleton.joints.empty() || skeleton.jointCount() > kMaxSkinJoints) {
    throw KnownError(ErrorKind::kTooManyJoints,
                     {ErrorCode::kBadArgument,
                      fmt::format("a rig has 1 to {} joints, not {}", kMaxSkinJoints, skeleton.joints.size())},
                     {{"count", fmt::to_string(skeleton.joints.size())}, {"most", fmt::to_string(kMaxSkinJoints)}});
  }
  if (weights.vertexCount() != geometry.positions.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("weights for {} vertices, but the geometry has {}",
                                                     weights.vertexCount(), geometry.positions.size()));
  }
  for (const PrimitiveInstance& instance : geometry.instances) {
    if (instance.node < asset.document.nodes.size() && instance.mesh < asset.document.meshes.size()) continue;
    throw Error(ErrorCode::kBadArgument, "the geometry is not that of this asset");
  }
}

// The new joint nodes of an attached rig.
struct RigNodes {
  Index root = 0;
  std::vector<Index> joints;   // #J nodes
  std::vector<Affine> toBind;  // #J, world -> joint, of the joints as stored
};

RigNodes addRigNodes(Asset& asset, const Skeleton& skeleton) {
  UniqueNames names;
  std::vector<gltf::Node>& nodes = asset.document.nodes;
  for (const gltf::Node& node : nodes) names.add(node.name);
  RigNodes rig;
  rig.root = addElement(nodes, gltf::Node());
  nodes[rig.root].name = names.add(kRigName);

  std::vector<Affine> globals;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Joint& joint = skeleton.joints[j];
    const Transform rest = rounded(joint.rest);
    const Affine local = rest.toAffine();
    globals.push_back(joint.parent ? globals[*joint.parent] * local : local);
    rig.toBind.push_back(globals.back().inverse(Eigen::Affine));
    if (!rig.toBind.back().matrix().allFinite()) {
      throw Error(ErrorCode::kBadData, "has a rest transform without an inverse",
                  fmt::format("joint '{}'", joint.name));
    }
    const bool withRadius = skeleton.boneShape == BoneShape::kSphere || joint.radius > 0;
    const Index node = addElement(nodes, jointNode(joint, rest, names.add(joint.name), withRadius));
    rig.joints.push_back(node);
    nodes[joint.parent ? rig.joints[*joint.parent] : rig.root].children.push_back(node);
  }
  return rig;
}

}  // namespace

std::vector<Index> attachRig(Asset& asset, const Geometry& geometry, const Skeleton& skeleton,
                             const SkinWeights& weights) {
  checkArguments(asset, geometry, skeleton, weights);
  std::vector<Index> identity(skeleton.jointCount());
  for (Index j = 0; j < identity.size(); ++j) identity[j] = j;

  const AccessorSweep unused(asset);
  SkinnedNodes skinned(asset, geometry);
  const RigNodes rig = addRigNodes(asset, skeleton);
  skinned.showInScenes(rig.root);
  for (const MeshGroup& group : skinned.groups()) {
    const Index mesh = skinned.meshFor(group);
    for (Index i = group.firstInstance; i < group.endInstance; ++i) {
      const PrimitiveInstance& instance = geometry.instances[i];
      writeWeightAttributes(asset, {mesh, instance.primitive}, instance, weights, identity, skeleton.jointCount());
    }
    skinned.attach(group, mesh, skinned.addSkin({kRigName, rig.joints, rig.toBind, rig.root}, group.toWorld));
  }
  skinned.finish();
  unused.sweep(asset);
  return rig.joints;
}

}  // namespace limber
