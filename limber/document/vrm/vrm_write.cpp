#include "limber/document/vrm/vrm_write.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/rotation.h"
#include "limber/core/text/names.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/rig/rest_pose.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/scene/turn_scene.h"
#include "limber/document/vrm/hang_bones.h"
#include "limber/document/vrm/t_pose.h"
#include "limber/document/vrm/vrm0.h"
#include "limber/document/vrm/vrm_bones.h"
#include "limber/document/vrm/vrm_expressions.h"
#include "limber/document/write.h"

namespace limber {

namespace {

// Do the nodes stand in a pose of their own: neither at rest nor as a clip begins, which goes on showing it?
bool isPosed(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  constexpr double kTurned = 20 * kPi / 180;  // radians
  const Pose rest = restPose(rig.skeleton), pose = readNodePose(asset, rig);
  const auto isLike = [&](const Pose& other) {
    return std::none_of(bones.begin(), bones.end(), [&](const HumanoidJoint& bone) {
      const Quat &turn = pose.locals[bone.joint].rotation, &otherTurn = other.locals[bone.joint].rotation;
      return rig.skeleton.joints[bone.joint].parent && angleBetween(turn, otherTurn) > kTurned;
    });
  };
  if (isLike(rest)) return false;
  Warnings warnings;  // by whoever reads them for their own sake
  const std::vector<Clip> clips = readClips(asset, rig, warnings);
  return std::none_of(clips.begin(), clips.end(), [&](const Clip& clip) {
    Pose first = rest;
    sampleClip(clip, 0, first);
    return isLike(first);
  });
}

// The joints' nodes to a T-pose that faces +Z; the bones as "humanoid" has them. `isVrm`: the nodes are known to have
// stood in T-pose, and do no longer.
Json standInTPose(Asset& asset, bool isVrm) {
  if (!hasRig(asset)) {
    throw Error(ErrorCode::kUnsupported, "has no rig, and a VRM needs one", asset.name,
                "give it one by limber rig --template humanoid");
  }
  const AssetSkeleton read = readSkeleton(asset);
  std::vector<HumanoidJoint> bones = vrmBones(asset, read, asset.warnings);
  const AssetSkeleton rig = hangBones(asset, read, bones);
  if (isVrm || isPosed(asset, rig, bones)) {
    asset.warnings.add("vrm-pose", "a VRM rests in T-pose, and the pose of the model's joints is not kept");
  }
  const TPose tPose = madeTPose(asset, rig, bones);
  setNodePose(asset, rig, tPose.pose);
  constexpr double kFacesFront = 1e-6, kReported = 0.02;  // radians
  const double turn = angleBetween(tPose.toVrm, Quat::Identity());
  if (turn > kFacesFront) turnScene(asset, tPose.toVrm, "facing_front");
  if (turn > kReported && !asset.document.animations.empty()) {
    asset.warnings.add("vrm-turned", fmt::format("a VRM faces +Z: clips are turned by {:.0f} degrees with the model",
                                                 turn * 180 / kPi));
  }
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
  if (!hasAllBones(asset.document, kVrmName)) {
    vrm["humanoid"] = standInTPose(asset, false);
  } else if (hasRig(asset) && !restsInTPose(asset, kVrmName)) {
    standInTPose(asset, true);
  }
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
