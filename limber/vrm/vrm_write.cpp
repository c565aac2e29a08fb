#include "limber/vrm/vrm_write.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/asset/extensions.h"
#include "limber/asset/humanoid_nodes.h"
#include "limber/asset/json_access.h"
#include "limber/asset/pose_io.h"
#include "limber/asset/rest_pose.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/turn_scene.h"
#include "limber/asset/write.h"
#include "limber/core/names.h"
#include "limber/core/rotation.h"
#include "limber/vrm/hang_bones.h"
#include "limber/vrm/t_pose.h"
#include "limber/vrm/vrm0.h"
#include "limber/vrm/vrm_bones.h"
#include "limber/vrm/vrm_expressions.h"

namespace limber {

namespace {

// The joints' nodes to a T-pose that faces +Z; the bones as "humanoid" has them.
Json standInTPose(Asset& asset) {
  if (!hasRig(asset)) {
    throw Error(ErrorCode::kUnsupported, "has no rig, and a VRM needs one", asset.name, "give it one by limber rig");
  }
  const AssetSkeleton read = readSkeleton(asset);
  std::vector<HumanoidJoint> bones = vrmBones(asset, read, asset.warnings);
  const AssetSkeleton rig = hangBones(asset, read, bones);
  const TPose tPose = madeTPose(asset, rig, bones);
  setNodePose(asset, rig, tPose.pose);
  constexpr double kFacesFront = 1e-6;  // radians
  if (angleBetween(tPose.toVrm, Quat::Identity()) > kFacesFront) turnScene(asset, tPose.toVrm, "facing_front");
  Json humanBones = Json::object();
  for (const HumanoidJoint& bone : bones) humanBones[std::string(bone.bone)] = {{"node", rig.jointNode[bone.joint]}};
  return {{"humanBones", std::move(humanBones)}};
}

void tellOfScales(Asset& asset) {
  constexpr double kSameScale = 1e-4;  // relative; rounding of single precision and of matrices is less
  std::size_t uneven = 0;
  for (const gltf::Node& node : asset.document.nodes) {
    const Vec3 scale = decompose(nodeTransform(node)).scale;
    uneven += scale.minCoeff() <= 0 || scale.maxCoeff() > (1 + kSameScale) * scale.minCoeff() ? 1 : 0;
  }
  asset.warnings.add("vrm-scales", "nodes have scales that differ by axis, which VRM does not allow", {}, uneven);
}

}  // namespace

void makeVrm(Asset& asset, const VrmMeta& meta) {
  if (extensionOf(asset.document, kVrmName) == nullptr) upgradeVrm0(asset);
  const Json* kept = extensionOf(asset.document, kVrmName);
  const bool isVrm = kept != nullptr;
  Json vrm = isVrm && kept->is_object() ? *kept : Json::object();
  vrm["specVersion"] = "1.0";
  const std::string stem = std::filesystem::path(asset.name).stem().string();
  const Json* keptMeta = member(vrm, "meta");
  vrm["meta"] = vrmMeta(meta, keptMeta != nullptr && keptMeta->is_object() ? keptMeta : nullptr, stem, asset.warnings);
  if (!hasAllBones(asset.document, kVrmName)) vrm["humanoid"] = standInTPose(asset);
  if (!isVrm) {
    if (Json expressions = expressionsByName(asset.document); !expressions.is_null()) {
      vrm["expressions"] = std::move(expressions);
    }
  }
  changeExtension(asset.document, kVrmName) = std::move(vrm);
  declareExtension(asset.document, kVrmName);
  tellOfScales(asset);
}

}  // namespace limber
