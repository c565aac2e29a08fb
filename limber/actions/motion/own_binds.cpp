#include "limber/actions/motion/own_binds.h"

#include <algorithm>
#include <map>

#include "limber/document/rig/bind_pose.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

SkinWeights rowsOf(const SkinWeights& weights, Index first, Index count) {
  const auto begin = static_cast<std::ptrdiff_t>(std::size_t{first} * weights.slots);
  const auto end = begin + static_cast<std::ptrdiff_t>(std::size_t{count} * weights.slots);
  return {weights.slots,
          {weights.joints.begin() + begin, weights.joints.begin() + end},
          {weights.weights.begin() + begin, weights.weights.begin() + end}};
}

}  // namespace

OwnBinds::OwnBinds(const Character& character, const AssetSkeleton& skeleton, const SkinWeights& weights)
    : character_(character), normals_(readNormals(character.document(), character.surface())) {
  const Asset& asset = character.document();
  const BindPose pose = readBindPose(asset, readSceneGraph(asset.document));
  const std::vector<Index> elsewhere = skinsBoundElsewhere(asset, pose);
  const std::vector<Affine> rest = restGlobals(skeleton.skeleton);
  std::map<Index, Index> jointOf;  // by node
  for (Index j = 0; j < skeleton.jointNode.size(); ++j) jointOf[skeleton.jointNode[j]] = j;
  for (const PrimitiveInstance& instance : character.surface().instances) {
    const std::optional<Index> skin = asset.document.nodes[instance.node].skin;
    if (!skin || std::find(elsewhere.begin(), elsewhere.end(), *skin) == elsewhere.end()) continue;
    Part part;
    part.firstVertex = instance.firstVertex;
    part.weights = rowsOf(weights, instance.firstVertex, instance.vertexCount);
    part.toRest.assign(rest.size(), Affine::Identity());
    part.centers = restPositions(skeleton.skeleton);
    const SkinBinding binding = readSkinBinding(asset, *skin);
    const Affine toMesh = pose.skinToWorld[*skin].inverse(Eigen::Affine);
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
      const auto joint = jointOf.find(binding.joints[j]);
      if (joint == jointOf.end()) continue;
      const Affine toRest = rest[joint->second] * binding.inverseBinds[j] * toMesh;
      part.toRest[joint->second] = toRest;
      const Vec3 center = toRest.inverse(Eigen::Affine) * part.centers[joint->second];
      if (center.allFinite()) part.centers[joint->second] = center;
    }
    parts_.push_back(std::move(part));
  }
}

void OwnBinds::deform(const Deformer& deformer, std::span<const Affine> transforms, const ShapeWeights& shapes,
                      std::span<Vec3f> positions, std::span<Vec3f> normals) const {
  Geometry shaped = character_.surface();
  std::vector<Vec3f> shapedNormals = normals_;
  moveByShapes(character_.document(), shapes, shaped, &shapedNormals);
  std::vector<Affine> own(transforms.size());
  for (const Part& part : parts_) {
    const std::size_t count = part.weights.vertexCount();
    for (std::size_t j = 0; j < own.size(); ++j) own[j] = transforms[j] * part.toRest[j];
    std::vector<float> scratch(deformer.scratchSize(count, static_cast<Index>(own.size())));
    const auto of = [&](auto& vectors) { return std::span(vectors).subspan(part.firstVertex, count); };
    deformer.deform({of(shaped.positions), of(shapedNormals), part.weights, own, part.centers},
                    {of(positions), of(normals)}, scratch);
  }
}

}  // namespace limber
