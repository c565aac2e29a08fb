#include "limber/actions/pose/pose_asset.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/actions/edit_text.h"
#include "limber/core/text/numbers.h"
#include "limber/document/rig/pose_io.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/ik/ik_solver.h"

namespace limber {

namespace {

Affine parentGlobal(const Skeleton& skeleton, const Pose& pose, Index joint) {
  const std::optional<Index> parent = skeleton.joints[joint].parent;
  return parent ? poseGlobals(skeleton, pose)[*parent] : Affine::Identity();
}

void turn(const Skeleton& skeleton, Pose& pose, const JointTurn& edit) {
  const Index joint = requireJoint(skeleton, edit.joint, edit.where);
  const Quat above = decompose(parentGlobal(skeleton, pose, joint)).rotation;
  const Quat turned(Eigen::AngleAxisd(edit.degrees * kDegree, above.conjugate() * edit.axis));
  pose.locals[joint].rotation = (turned * pose.locals[joint].rotation).normalized();
}

void move(const Skeleton& skeleton, Pose& pose, const JointMove& edit) {
  const Index joint = requireJoint(skeleton, edit.joint, edit.where);
  const Vec3 local = parentGlobal(skeleton, pose, joint).linear().inverse() * edit.offset;
  if (!local.allFinite()) {
    throw Error(ErrorCode::kBadData, fmt::format("joint '{}' cannot be moved below a scale of 0", edit.joint),
                edit.where);
  }
  pose.locals[joint].translation += local;
}

IkTarget targetOf(const Skeleton& skeleton, const JointReach& edit) {
  IkTarget target;
  target.joint = requireJoint(skeleton, edit.joint, edit.where);
  target.position = edit.target;
  target.pole = edit.pole;
  if (!edit.base) return target;
  target.base = requireJoint(skeleton, *edit.base, edit.where);
  if (!isAncestorOrSelf(skeleton, *target.base, target.joint)) {
    throw Error(ErrorCode::kBadArgument,
                fmt::format("the base '{}' is not above the joint '{}'", *edit.base, edit.joint), edit.where);
  }
  return target;
}

std::vector<ReachReport> reach(const Skeleton& skeleton, Pose& pose, const std::vector<JointReach>& edits,
                               const JointLimits* limits, const PoseOptions& options) {
  std::vector<IkTarget> targets;
  for (const JointReach& edit : edits) {
    const IkTarget target = targetOf(skeleton, edit);
    const auto isSame = [&](const IkTarget& other) { return other.joint == target.joint; };
    if (std::any_of(targets.begin(), targets.end(), isSame)) {
      throw Error(ErrorCode::kBadArgument, fmt::format("joint '{}' already reaches for another point", edit.joint),
                  edit.where, "give each joint one point to reach");
    }
    targets.push_back(target);
  }
  const IkResult result = solveIk(findIkMethod(options.solver), skeleton, pose, targets, limits, options.ik);
  std::vector<ReachReport> reports;
  for (std::size_t e = 0; e < edits.size(); ++e) {
    reports.push_back({edits[e].joint, result.targets[e].distance, result.targets[e].outcome});
  }
  return reports;
}

}  // namespace

std::vector<ReachReport> editPose(const Skeleton& skeleton, Pose& pose, const PoseEdits& edits,
                                  const JointLimits* limits, const PoseOptions& options) {
  for (const JointTurn& edit : edits.turns) {
    turn(skeleton, pose, edit);
    const Index joint = requireJoint(skeleton, edit.joint, edit.where);
    if (limits) pose.locals[joint].rotation = nearestAllowed(limits->joints[joint], pose.locals[joint].rotation);
  }
  for (const JointScale& edit : edits.scales) {
    pose.locals[requireJoint(skeleton, edit.joint, edit.where)].scale *= edit.factor;
  }
  for (const JointMove& edit : edits.moves) move(skeleton, pose, edit);
  if (edits.reaches.empty()) return {};
  return reach(skeleton, pose, edits.reaches, limits, options);
}

AssetPoser::AssetPoser(const Character& character, const AssetSkeleton& skeleton, const Deformer& deformer)
    : character_(character), whole_(character.inOneBindPose()), skeleton_(skeleton.skeleton), deformer_(deformer) {
  bound_ = {whole_.surface(), readNormals(whole_.document(), whole_.surface())};
  shapes_ = readShapeWeights(whole_.document());
  moveByShapes(whole_.document(), shapes_, bound_.geometry, &bound_.normals);
  weights_ = readWeights(whole_.document(), whole_.surface(), skeleton);
  normalizeWeights(weights_);
  centers_ = restPositions(skeleton_);
  prepared_ = prepareDeformer(deformer, {bound_.geometry.positions, bound_.geometry.triangles, weights_},
                              skeleton_.jointCount());
  if (isJoined() && !deformer.prepare) ownBinds_.emplace(character, skeleton, weights_);
}

PosedGeometry AssetPoser::posed(const Pose& pose, const ShapeWeights& shapes) const {
  PosedGeometry shaped = bound_;
  moveByShapes(whole_.document(), shapes, shaped.geometry, &shaped.normals);
  return moved(std::move(shaped), pose, shapes);
}

PosedGeometry AssetPoser::moved(PosedGeometry result, const Pose& pose, const ShapeWeights& shapes) const {
  std::vector<Vec3f>& positions = result.geometry.positions;
  const std::vector<Affine> transforms = skinTransforms(skeleton_, pose);
  std::vector<float> scratch(deformer_.scratchSize(positions.size(), skeleton_.jointCount()));
  if (isJoined()) result.geometry.instances = character_.surface().instances;
  deformer_.deform({positions, result.normals, weights_, transforms, centers_, prepared_.get()},
                   {positions, result.normals}, scratch);
  if (ownBinds_) ownBinds_->deform(deformer_, transforms, shapes, positions, result.normals);
  return result;
}

PosedGeometry posedGeometry(const Character& character, const AssetSkeleton& skeleton, const Pose& pose,
                            const Deformer& deformer) {
  return AssetPoser(character, skeleton, deformer).posed(pose);
}

}  // namespace limber
