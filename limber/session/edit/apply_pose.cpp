#include "limber/session/edit/apply_pose.h"

#include <utility>

#include <fmt/format.h>

#include "limber/actions/pose/put_pose.h"
#include "limber/core/error.h"
#include "limber/document/clip/pose_file.h"
#include "limber/session/edit/mirror_pose.h"

namespace limber {

namespace {

// `before` with the joints that are named as `pose` has them.
Pose onJoints(const Skeleton& skeleton, const std::vector<std::string>& names, Pose before, const Pose& pose) {
  for (const std::string& name : names) {
    const std::optional<Index> joint = skeleton.find(name);
    if (!joint) throw Error(ErrorCode::kBadArgument, fmt::format("no joint is called '{}'", name));
    before.locals[*joint] = pose.locals[*joint];
  }
  return before;
}

}  // namespace

Pose appliedPose(const RiggedModel& rig, const Pose& now, const ApplyPose& command) {
  Pose pose = putPose(poseFromJson(command.pose), rig.skeleton(), now);
  if (command.mirrored) {
    const auto [plane, images] = mirrorOfRig(rig);
    pose = mirrorPose(rig.skeleton(), pose, plane, images, MirrorFrom::kBoth);
  }
  return command.joints.empty() ? pose : onJoints(rig.skeleton(), command.joints, now, pose);
}

}  // namespace limber
