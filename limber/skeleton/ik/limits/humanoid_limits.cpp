// Sources, where not named in a row:
//   AAOS: American Academy of Orthopaedic Surgeons: Joint Motion, Method of Measuring and Recording, 1965
#include "limber/skeleton/ik/limits/humanoid_limits.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"

namespace limber {

namespace {

enum class Kind { kHinge, kBall, kCondyloid, kSaddle, kSwingTwist };

// Directions in the space of a character in T-pose that faces +Z, of the left side. x, z and twist in degrees about the
// limit's axes: Y along the bone, X as given, Z = X x Y; x is flexion unless said otherwise.
struct Row {
  HumanoidRange range;
  bool sided;
  Kind kind;
  Vec3 tPose;    // direction of the bone in T-pose, where all angles are 0; 0: as in rest pose
  Vec3 flexion;  // X
  AngleRange x, z, twist;
};

const Vec3 kAsItIs = Vec3::Zero();
const Vec3 kLeft = Vec3::UnitX(), kUp = Vec3::UnitY(), kFront = Vec3::UnitZ();
constexpr const char* kAaos = "AAOS 1965";
constexpr const char* kNorkin = "Norkin, White: Measurement of Joint Motion, 2016";
constexpr const char* kLevangie = "Levangie, Norkin: Joint Structure and Function, 2011: sternoclavicular joint";

// clang-format off
const std::array<Row, 30>& rows() {
  static const std::array<Row, 30> kRows = {{
      // The thoracolumbar spine: flexion 80, extension 25, to each side 35, rotation 45; shared among three bones below.
      {{"spine", "chest", kAaos}, false, Kind::kSwingTwist, kUp, kLeft, {-25, 80}, {-35, 35}, {-45, 45}},
      {{"chest", "upperChest", kAaos}, false, Kind::kSwingTwist, kUp, kLeft, {-25, 80}, {-35, 35}, {-45, 45}},
      {{"upperChest", "neck", kAaos}, false, Kind::kSwingTwist, kUp, kLeft, {-25, 80}, {-35, 35}, {-45, 45}},
      // The cervical spine: flexion and extension 45, to each side 45, rotation 60; shared between two.
      {{"neck", "head", kAaos}, false, Kind::kSwingTwist, kUp, kLeft, {-45, 45}, {-45, 45}, {-60, 60}},
      {{"head", "headTop", kAaos}, false, Kind::kSwingTwist, kUp, kLeft, {-45, 45}, {-45, 45}, {-60, 60}},
      {{"jaw", "", kNorkin}, false, Kind::kHinge, kAsItIs, kLeft, {0, 30}, {}, {}},
      // Down 47, up 28, to each side 45.
      {{"Eye", "", "Shin et al.: Measurement of ocular ductions, 2016"}, true, Kind::kCondyloid, kFront, kLeft,
       {-28, 47}, {-45, 45}, {}},
      // x: elevation and depression; z: retraction and protraction; twist: backward rotation is negative.
      {{"Shoulder", "UpperArm", kLevangie}, true, Kind::kBall, kLeft, kFront, {-15, 45}, {-20, 30}, {-50, 10}},
      // From the T-pose, so that no swing comes near half a turn, where twist means nothing. x: horizontal flexion 135,
      // extension 45; z: up 90 (abduction 180), down 90 and 45 across the body; twist at 90 degrees of abduction: inward
      // 70, outward 90.
      {{"UpperArm", "LowerArm", kAaos}, true, Kind::kBall, kLeft, -kUp, {-45, 135}, {-135, 90}, {-90, 70}},
      // The elbow, and pronation and supination of the forearm.
      {{"LowerArm", "Hand", kAaos}, true, Kind::kSwingTwist, kLeft, -kUp, {0, 150}, {0, 0}, {-80, 80}},
      // z: to the thumb's side 20, to the other 30.
      {{"Hand", "MiddleProximal", kAaos}, true, Kind::kCondyloid, kLeft, -kFront, {-70, 80}, {-30, 20}, {}},
      {{"ThumbMetacarpal", "ThumbProximal", kAaos}, true, Kind::kSaddle, kAsItIs, kUp, {-20, 15}, {0, 70}, {}},
      {{"ThumbProximal", "ThumbDistal", kAaos}, true, Kind::kHinge, kAsItIs, kUp, {0, 50}, {}, {}},
      {{"ThumbDistal", "", kAaos}, true, Kind::kHinge, kAsItIs, kUp, {-20, 80}, {}, {}},
      {{"IndexProximal", "IndexIntermediate", kAaos}, true, Kind::kCondyloid, kAsItIs, -kFront, {-45, 90}, {-20, 20}, {}},
      {{"IndexIntermediate", "IndexDistal", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 100}, {}, {}},
      {{"IndexDistal", "", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 90}, {}, {}},
      {{"MiddleProximal", "MiddleIntermediate", kAaos}, true, Kind::kCondyloid, kAsItIs, -kFront, {-45, 90}, {-20, 20}, {}},
      {{"MiddleIntermediate", "MiddleDistal", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 100}, {}, {}},
      {{"MiddleDistal", "", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 90}, {}, {}},
      {{"RingProximal", "RingIntermediate", kAaos}, true, Kind::kCondyloid, kAsItIs, -kFront, {-45, 90}, {-20, 20}, {}},
      {{"RingIntermediate", "RingDistal", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 100}, {}, {}},
      {{"RingDistal", "", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 90}, {}, {}},
      {{"LittleProximal", "LittleIntermediate", kAaos}, true, Kind::kCondyloid, kAsItIs, -kFront, {-45, 90}, {-20, 20}, {}},
      {{"LittleIntermediate", "LittleDistal", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 100}, {}, {}},
      {{"LittleDistal", "", kAaos}, true, Kind::kHinge, kAsItIs, -kFront, {0, 90}, {}, {}},
      // z: abduction 45, adduction 30; twist: 45 in each direction.
      {{"UpperLeg", "LowerLeg", kAaos}, true, Kind::kBall, -kUp, -kLeft, {-30, 120}, {-30, 45}, {-45, 45}},
      {{"LowerLeg", "Foot", kAaos}, true, Kind::kHinge, -kUp, kLeft, {0, 135}, {}, {}},
      // x: toes up 20, down 50; twist: sole inward 35, outward 15.
      {{"Foot", "Toes", kAaos}, true, Kind::kSwingTwist, kAsItIs, -kLeft, {-50, 20}, {0, 0}, {-35, 15}},
      {{"Toes", "", kAaos}, true, Kind::kHinge, kAsItIs, -kLeft, {-45, 70}, {}, {}},
  }};
  return kRows;
}
// clang-format on

AngleRange radians(const AngleRange& degrees, double fraction, bool mirrored) {
  const double scale = fraction * kPi / 180;
  return mirrored ? AngleRange{-scale * degrees.max, -scale * degrees.min}
                  : AngleRange{scale * degrees.min, scale * degrees.max};
}

// The mirror image keeps rotations about X; rotations about Y and Z change sign.
JointMotion motionOf(const Row& row, double fraction, bool mirrored) {
  const AngleRange x = radians(row.x, fraction, false), z = radians(row.z, fraction, mirrored);
  const AngleRange twist = radians(row.twist, fraction, mirrored);
  switch (row.kind) {
    case Kind::kHinge:
      return Hinge{x};
    case Kind::kBall:
      return BallAndSocket{x, z, twist};
    case Kind::kCondyloid:
      return Condyloid{x, z};
    case Kind::kSaddle:
      return Saddle{x, z};
    case Kind::kSwingTwist:
      return SwingTwist{x, z, twist};
  }
  return FreeJoint{};
}

// Directions mirror as arrows, axes of rotation as axes.
Vec3 mirrorArrow(const Vec3& v, bool mirrored) {
  return mirrored ? Vec3(-v.x(), v.y(), v.z()) : v;
}

Vec3 mirrorAxis(const Vec3& v, bool mirrored) {
  return mirrored ? Vec3(v.x(), -v.y(), -v.z()) : v;
}

// The row of a bone and its side; none for bones without limits.
struct RowOfBone {
  const Row* row = nullptr;
  bool mirrored = false;
  std::string side;
};

RowOfBone rowOf(std::string_view bone) {
  for (const Row& row : rows()) {
    if (!row.sided && bone == row.range.bone) return {&row, false, ""};
    for (const char* side : {"left", "right"}) {
      if (row.sided && bone == std::string(side).append(row.range.bone)) return {&row, side[0] == 'r', side};
    }
  }
  return {};
}

class LimitBuilder {
 public:
  LimitBuilder(const Skeleton& skeleton, std::span<const HumanoidJoint> joints)
      : skeleton_(skeleton), joints_(joints), bones_(skeleton.jointCount()), tips_(skeleton.jointCount()) {
    for (const HumanoidJoint& joint : joints) {
      if (joint.joint >= skeleton.jointCount()) {
        throw Error(ErrorCode::kBadArgument,
                    fmt::format("bone '{}' is joint {}, which is not there", joint.bone, joint.joint));
      }
      bones_[joint.joint] = rowOf(joint.bone);
      if (bones_[joint.joint].row) tips_[joint.joint] = tipOf(joint.joint, bones_[joint.joint]);
    }
  }

  JointLimits build() const {
    JointLimits limits;
    limits.joints.resize(skeleton_.jointCount());
    std::vector<Quat> globals(skeleton_.jointCount());
    for (Index j = 0; j < skeleton_.jointCount(); ++j) {
      const Joint& joint = skeleton_.joints[j];
      const Quat parent = joint.parent ? globals[*joint.parent] : Quat::Identity();
      globals[j] = (parent * joint.rest.rotation).normalized();
      if (bones_[j].row) limits.joints[j] = limitOf(j, parent, globals[j]);
    }
    return limits;
  }

 private:
  // Where the bone ends, in the joint's frame: at the joint that plays its tip, else at the only child.
  Vec3 tipOf(Index joint, const RowOfBone& bone) const {
    const std::string tip(bone.row->range.tip);
    Vec3 onlyChild = Vec3::Zero();
    int children = 0;
    for (Index c = 0; c < skeleton_.jointCount(); ++c) {
      if (skeleton_.joints[c].parent != joint) continue;
      const bool isTip = std::any_of(joints_.begin(), joints_.end(), [&](const HumanoidJoint& other) {
        return other.joint == c && !tip.empty() && (other.bone == tip || other.bone == bone.side + tip);
      });
      if (isTip) return skeleton_.joints[c].rest.translation;
      ++children;
      onlyChild = skeleton_.joints[c].rest.translation;
    }
    return children == 1 ? onlyChild : Vec3::Zero();
  }

  // Bends `global` to the T-pose, and builds the limit round it.
  JointLimit limitOf(Index joint, const Quat& parent, Quat& global) const {
    const RowOfBone& bone = bones_[joint];
    const Row& row = *bone.row;
    const Vec3 tPose = mirrorArrow(row.tPose, bone.mirrored);
    const Vec3 tip = global * tips_[joint];
    if (tPose != kAsItIs && tip.norm() > 0) global = (shortestRotation(tip, tPose) * global).normalized();
    Vec3 direction = tip.norm() > 0 ? Vec3((global * tips_[joint]).normalized()) : tPose;
    if (direction == kAsItIs) direction = parentDirection(joint, parent);

    // The bone is seldom exactly across the axis, which is therefore adjusted.
    const Vec3 flexion = mirrorAxis(row.flexion, bone.mirrored);
    const Vec3 x = (flexion - flexion.dot(direction) * direction).normalized();
    Mat3 axes;
    axes << x, direction, x.cross(direction);

    JointLimit limit;
    limit.motion = motionOf(row, fractionOf(row), bone.mirrored);
    limit.neutral = (parent.conjugate() * global).normalized();
    limit.axes = (global.conjugate() * Quat(axes)).normalized();
    limit.restTranslation = skeleton_.joints[joint].rest.translation;
    return limit;
  }

  // A bone without an end of its own goes on as its parent's does.
  Vec3 parentDirection(Index joint, const Quat& parent) const {
    const Vec3 displacement = parent * skeleton_.joints[joint].rest.translation;
    return displacement.norm() > 0 ? Vec3(displacement.normalized()) : kFront;
  }

  // The range of the spine and of the neck is divided among the bones that are there.
  double fractionOf(const Row& row) const {
    const auto amongThem = [&](std::initializer_list<std::string_view> names) {
      if (std::find(names.begin(), names.end(), row.range.bone) == names.end()) return 1.0;
      const auto there = std::count_if(joints_.begin(), joints_.end(), [&](const HumanoidJoint& joint) {
        return std::find(names.begin(), names.end(), joint.bone) != names.end();
      });
      return 1.0 / static_cast<double>(there);
    };
    return amongThem({"spine", "chest", "upperChest"}) * amongThem({"neck", "head"});
  }

  const Skeleton& skeleton_;
  std::span<const HumanoidJoint> joints_;
  std::vector<RowOfBone> bones_;  // #J
  std::vector<Vec3> tips_;        // #J, 0 where a bone has no end
};

}  // namespace

std::span<const HumanoidRange> humanoidRanges() {
  static const std::vector<HumanoidRange> kRanges = [] {
    std::vector<HumanoidRange> ranges;
    for (const Row& row : rows()) ranges.push_back(row.range);
    return ranges;
  }();
  return kRanges;
}

JointLimits humanoidLimits(const Skeleton& skeleton, std::span<const HumanoidJoint> joints) {
  return LimitBuilder(skeleton, joints).build();
}

}  // namespace limber
