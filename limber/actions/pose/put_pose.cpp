#include "limber/actions/pose/put_pose.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "limber/actions/rig/stand_upright.h"
#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/known_error.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/clip/keys/keyframes.h"

namespace limber {

namespace {

constexpr std::string_view kPoseMethod = "limb-ik";

// A clip of that one moment.
Motion motionOf(const PortablePose& pose, const SkeletonReading& skeleton) {
  Motion motion;
  motion.skeleton = pose.skeleton;
  setKey(motion.clips.emplace_back(), motion.skeleton, pose.pose, 0);
  return asItRests(std::move(motion), skeleton);
}

SkeletonMap matchBodies(const PortablePose& pose, const Motion& posed, const SkeletonReading& from,
                        const SkeletonReading& to) {
  try {
    return matchMotion(posed, from, to);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kUnsupported) throw;
    throw KnownError(ErrorKind::kUnlikePose,
                     {ErrorCode::kUnsupported, "the pose was made for another kind of body", pose.name,
                      "choose one of a body that is built like this one"},
                     {{"name", pose.name}});
  }
}

// The joints that support the body, as far as both have them; else the root joints.
std::vector<Index> standingJoints(const SkeletonMap& map, const Skeleton& skeleton) {
  std::vector<Index> joints;
  for (const JointMatch& match : map.matches) {
    if (match.part.kind == PartKind::kLeg && match.part.segment == Segment::kEnd) {
      joints.push_back(match.target.front());
    }
  }
  if (!joints.empty()) return joints;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) joints.push_back(j);
  }
  return joints;
}

Vec3 middleOfJoints(const std::vector<Index>& joints, const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  for (const Index joint : joints) sum += positions[joint];
  return sum / static_cast<double>(joints.size());
}

void stayAbove(const Vec3& position, const std::vector<Index>& joints, const Skeleton& skeleton, Pose& pose) {
  Vec3 shift = position - middleOfJoints(joints, posePositions(skeleton, pose));
  shift.y() = 0;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) pose.locals[j].translation += shift;
  }
}

bool isFinite(const Pose& pose) {
  return std::all_of(pose.locals.begin(), pose.locals.end(), [](const Transform& local) {
    return local.translation.allFinite() && local.rotation.coeffs().allFinite() && local.scale.allFinite();
  });
}

}  // namespace

Pose putPose(const PortablePose& pose, const Skeleton& to, const Pose& now) {
  if (std::optional<Pose> same = poseByNames(pose, to)) return *std::move(same);

  const SkeletonReading from(pose.skeleton), reading(to);
  const Motion motion = motionOf(pose, from);
  const SkeletonMap map = matchBodies(pose, motion, from, reading);
  const PlainSkeleton source(motion.skeleton), target(to);
  const PoseSequence frames = source.plain(sampleFrames(motion.skeleton, motion.clips.front(), 1));
  RetargetOptions options;
  options.characterOnGround = true;
  // The rest pose tells where the ground is: who jumps has it below. One without form tells nothing.
  const bool tells = hasForm(source.skeleton(), restPose(source.skeleton()));
  const RetargetSetup setup(source.skeleton(), target.skeleton(), map, options, tells ? nullptr : &frames);
  Pose result = target.original(retargetFrames(findRetargetMethod(kPoseMethod), setup, frames)).poses.front();

  const Quat turn = turnToStand(reading);
  for (Index j = 0; j < to.jointCount(); ++j) {
    if (to.joints[j].parent) continue;
    result.locals[j].translation = turn * result.locals[j].translation;
    result.locals[j].rotation = turn * result.locals[j].rotation;
  }
  const std::vector<Index> standing = standingJoints(map, to);
  stayAbove(middleOfJoints(standing, posePositions(to, now)), standing, to, result);
  if (!isFinite(result)) {
    throw KnownError(ErrorKind::kUnfitPose, {ErrorCode::kUnsupported, "the pose does not fit this skeleton", pose.name},
                     {{"name", pose.name}});
  }
  return result;
}

}  // namespace limber
