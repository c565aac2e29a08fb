#include "limber/document/vrm/t_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "limber/character/anatomy/anatomy.h"
#include "limber/character/matching/neutral_pose.h"
#include "limber/character/matching/rest_form.h"
#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/humanoid_nodes.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/vrm/vrm_bones.h"

namespace limber {

namespace {

constexpr double kSamePosition = 1e-6;  // of the skeleton's size
// How far from a T-pose they are that still rest in one; the neutral pose may stoop by 25 degrees.
constexpr double kLimbsOff = 20 * kPi / 180, kTrunkOff = 30 * kPi / 180;  // radians

struct LimbBone {
  const char *from, *to;  // of VRM, without the side
  bool isArm;
};
constexpr std::array kLimbBones = {LimbBone{"UpperArm", "LowerArm", true}, LimbBone{"LowerArm", "Hand", true},
                                   LimbBone{"UpperLeg", "LowerLeg", false}, LimbBone{"LowerLeg", "Foot", false}};

Vec3 outwardOf(std::string_view side) {
  return side == "left" ? Vec3(Vec3::UnitX()) : Vec3(-Vec3::UnitX());
}
// Where it points in T-pose, in VRM's space.
Vec3 directionOf(const LimbBone& bone, std::string_view side) {
  return bone.isArm ? outwardOf(side) : Vec3(-Vec3::UnitY());
}

std::optional<Index> jointOf(std::span<const HumanoidJoint> bones, std::string_view bone) {
  const auto found = std::find_if(bones.begin(), bones.end(), [&](const HumanoidJoint& j) { return j.bone == bone; });
  return found == bones.end() ? std::nullopt : std::optional(found->joint);
}

// The neutral pose as locals. Joints that it moves without turning their parents have their translations changed.
Pose poseOf(const NeutralPose& neutral, const Skeleton& skeleton, const Pose& resting) {
  const Quat back = neutral.toBody.conjugate();
  Box box;
  for (const Vec3& position : neutral.positions) box.add(position);
  Pose pose = resting;
  std::vector<Affine> globals;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    const Quat above = parent ? Quat(back * neutral.rotations[*parent]) : Quat::Identity();
    Transform& local = pose.locals[j];
    local.rotation = (above.conjugate() * back * neutral.rotations[j]).normalized();
    const Affine parentGlobal = parent ? globals[*parent] : Affine::Identity();
    const Vec3 wanted = back * neutral.positions[j];
    if ((parentGlobal * local.translation - wanted).norm() > kSamePosition * box.diagonal()) {
      local.translation = parentGlobal.inverse(Eigen::Affine) * wanted;
    }
    globals.push_back(parentGlobal * local.toAffine());
  }
  return pose;
}

// Turns single bones of a pose to where they are to point.
class BoneAimer {
 public:
  BoneAimer(const Skeleton& skeleton, TPose& tPose, std::span<const HumanoidJoint> bones)
      : skeleton_(skeleton), tPose_(tPose), bones_(bones) {}

  // The bone from one joint to the other; nothing where either is missing. `direction` in VRM's space; its own height
  // is kept where `levelOnly`, so that it is turned about the vertical alone.
  void aim(std::string_view from, std::string_view to, const Vec3& direction, bool levelOnly = false) {
    const std::optional<Index> joint = jointOf(bones_, from), end = jointOf(bones_, to);
    if (!joint || !end) return;
    const std::vector<Vec3> positions = posePositions(skeleton_, tPose_.pose);
    Vec3 now = tPose_.toVrm * (positions[*end] - positions[*joint]), wanted = direction;
    if (levelOnly) now.y() = 0;
    if (now.norm() < 1e-9 || angleBetween(shortestRotation(now, wanted), Quat::Identity()) < 1e-9) return;
    turn(*joint, tPose_.toVrm.conjugate() * shortestRotation(now, wanted) * tPose_.toVrm);
  }

 private:
  // `by` in the skeleton's space.
  void turn(Index joint, const Quat& by) {
    Quat above = Quat::Identity();
    for (std::optional<Index> j = skeleton_.joints[joint].parent; j; j = skeleton_.joints[*j].parent) {
      above = tPose_.pose.locals[*j].rotation * above;
    }
    Quat& local = tPose_.pose.locals[joint].rotation;
    local = (above.conjugate() * by * above * local).normalized();
  }

  const Skeleton& skeleton_;
  TPose& tPose_;
  std::span<const HumanoidJoint> bones_;
};

void aimLimbs(BoneAimer& aimer) {
  for (const std::string side : {"left", "right"}) {
    const Vec3 outward = outwardOf(side);
    for (const LimbBone& bone : kLimbBones) aimer.aim(side + bone.from, side + bone.to, directionOf(bone, side));
    aimer.aim(side + "Hand", side + "MiddleProximal", outward);
    for (const char* finger : {"Index", "Middle", "Ring", "Little"}) {
      const std::string name = side + finger;
      aimer.aim(name + "Proximal", name + "Intermediate", outward);
      aimer.aim(name + "Intermediate", name + "Distal", outward);
    }
    aimer.aim(side + "Foot", side + "Toes", Vec3::UnitZ(), true);
  }
}

void lift(TPose& tPose, const Skeleton& skeleton, std::span<const HumanoidJoint> bones, double by) {
  const Index hips = *jointOf(bones, "hips");
  const std::optional<Index> parent = skeleton.joints[hips].parent;
  const Affine above = parent ? poseGlobals(skeleton, tPose.pose)[*parent] : Affine::Identity();
  const Mat3 toLocal = above.linear().inverse();
  if (toLocal.allFinite()) tPose.pose.locals[hips].translation += toLocal * (tPose.toVrm.conjugate() * Vec3(0, by, 0));
}

// #J: does the joint hang on a foot, or is it one?
std::vector<bool> footJoints(const Skeleton& skeleton, std::span<const HumanoidJoint> bones) {
  std::vector<bool> isFoot(skeleton.jointCount());
  for (const char* bone : {"leftFoot", "rightFoot"}) isFoot[*jointOf(bones, bone)] = true;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent && isFoot[*skeleton.joints[j].parent]) isFoot[j] = true;
  }
  return isFoot;
}

void putOnGround(TPose& tPose, const Skeleton& skeleton, std::span<const HumanoidJoint> bones) {
  const std::vector<bool> isFoot = footJoints(skeleton, bones);
  const std::vector<Vec3> positions = posePositions(skeleton, tPose.pose);
  double lowest = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (isFoot[j]) lowest = std::min(lowest, (tPose.toVrm * positions[j]).y());
  }
  lift(tPose, skeleton, bones, -lowest);
}

void putOnGround(TPose& tPose, const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  if (asset.document.meshes.empty()) return putOnGround(tPose, rig.skeleton, bones);
  const Geometry geometry = collectGeometry(asset);
  const SkinWeights weights = readWeights(asset, geometry, rig);
  const std::vector<Affine> skin = skinTransforms(rig.skeleton, tPose.pose);
  const std::vector<bool> isFoot = footJoints(rig.skeleton, bones);
  std::optional<double> lowest;
  for (Index v = 0; v < geometry.positions.size() && weights.slots > 0; ++v) {
    const auto joints = weights.jointsOf(v);
    const auto influences = weights.weightsOf(v);  // strongest first
    if (!(influences[0] > 0) || !isFoot[joints[0]]) continue;
    Vec3 position = Vec3::Zero();
    double sum = 0;
    for (Index slot = 0; slot < weights.slots; ++slot) {
      position += influences[slot] * (skin[joints[slot]] * geometry.positions[v].cast<double>());
      sum += influences[slot];
    }
    const double height = (tPose.toVrm * position).y() / sum;
    if (!lowest || height < *lowest) lowest = height;
  }
  if (!lowest) return putOnGround(tPose, rig.skeleton, bones);
  lift(tPose, rig.skeleton, bones, -*lowest);
}

Quat toVrmOf(std::string_view extension) {
  return extension == kVrm0Name ? Quat(0, 0, 1, 0) : Quat::Identity();  // 0.x faces -Z
}

// Do limbs and trunk point as in T-pose, as the nodes stand?
bool pointsAsTPose(const gltf::Document& document, const char* extension) {
  const Quat toVrm = toVrmOf(extension);
  const SceneGraph graph = readSceneGraph(document);
  std::map<std::string_view, Vec3, std::less<>> positions;
  for (const HumanoidNode& node : humanoidNodes(document, extension)) {
    positions[node.bone] = toVrm * graph.world[node.node].translation();
  }
  const auto points = [&](std::string_view from, std::string_view to, const Vec3& direction, double most) {
    const Vec3 bone = positions.at(to) - positions.at(from);
    return bone.dot(direction) >= std::cos(most) * bone.norm();
  };
  if (!points("hips", "head", Vec3::UnitY(), kTrunkOff)) return false;
  for (const std::string side : {"left", "right"}) {
    for (const LimbBone& bone : kLimbBones) {
      if (!points(side + bone.from, side + bone.to, directionOf(bone, side), kLimbsOff)) return false;
    }
  }
  return true;
}

// Is a bone turned, against the joint above it, otherwise than as it is bound and than in the T-pose made of that?
bool hasPosedBone(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  const Pose standing = readNodePose(asset, rig), bound = restPose(rig.skeleton);
  const Pose made = tPoseOf(rig.skeleton, std::span(&standing, 1), bones).pose;
  return std::any_of(bones.begin(), bones.end(), [&](const HumanoidJoint& bone) {
    const auto turnFrom = [&](const Pose& other) {
      return angleBetween(standing.locals[bone.joint].rotation, other.locals[bone.joint].rotation);
    };
    return rig.skeleton.joints[bone.joint].parent && std::min(turnFrom(bound), turnFrom(made)) > kLimbsOff;
  });
}

}  // namespace

TPose tPoseOf(const Skeleton& skeleton, std::span<const Pose> motion, std::span<const HumanoidJoint> bones) {
  const std::optional<Pose> pose = poseWithForm(skeleton, motion);
  const Skeleton read = pose ? restingIn(skeleton, *pose) : skeleton;
  const SkeletonMap map = matchSkeletons(read, read);
  const Pose resting = uprightPose(skeleton, motion, map, MapSide::kTarget);
  const NeutralPose neutral =
      neutralPose(skeleton, resting, map, MapSide::kTarget, readAnatomy(skeleton, resting).axes);
  TPose tPose{poseOf(neutral, skeleton, resting), neutral.toBody};
  BoneAimer aimer(skeleton, tPose, bones);
  aimLimbs(aimer);
  return tPose;
}

TPose madeTPose(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  const Pose standing = readNodePose(asset, rig);
  TPose tPose = tPoseOf(rig.skeleton, std::span(&standing, 1), bones);
  putOnGround(tPose, asset, rig, bones);
  return tPose;
}

bool restsInTPose(const Asset& asset, const char* extension) {
  if (!hasAllBones(asset.document, extension) || !pointsAsTPose(asset.document, extension)) return false;
  if (!hasRig(asset)) return true;
  const AssetSkeleton rig = readSkeleton(asset);
  return !hasPosedBone(asset, rig, bonesNamedBy(asset.document, extension, rig));
}

TPose vrmRestPose(const Asset& asset, const AssetSkeleton& rig, std::span<const HumanoidJoint> bones) {
  for (const char* extension : {kVrmName, kVrmAnimationName, kVrm0Name}) {
    if (restsInTPose(asset, extension)) return {readNodePose(asset, rig), toVrmOf(extension)};
  }
  return madeTPose(asset, rig, bones);
}

TPose vrmRestPose(const Motion& motion, std::span<const HumanoidJoint> bones) {
  constexpr int kMaxPoses = 100;  // of each clip, evenly spaced
  std::vector<Pose> poses;
  for (const Clip& clip : motion.clips) {
    for (int i = 0; i < kMaxPoses; ++i) {
      poses.push_back(restPose(motion.skeleton));
      sampleClip(clip, clip.duration() * i / kMaxPoses, poses.back());
    }
  }
  TPose tPose = tPoseOf(motion.skeleton, poses, bones);
  putOnGround(tPose, motion.skeleton, bones);
  return tPose;
}

}  // namespace limber
