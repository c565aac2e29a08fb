#include "limber/evaluate/skin/range_of_motion.h"

#include <cmath>
#include <optional>
#include <span>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr double kFraction = 0.5;          // of the range
constexpr double kStraight = 5 * kDegree;  // a limb bent by less does not tell where it bends to
constexpr double kParallel = 1e-3;         // sine: what points along a direction cannot be turned towards it

// Which joints of a part turn.
enum class Turned { kLimb, kMiddle, kEnd, kAlong };
// Where to: a direction that the part is turned towards, the bend that it has, or about the axis up.
enum class Towards { kFront, kBack, kUp, kDown, kLeft, kOutward, kBend, kTwist };

struct Movement {
  std::string_view name;
  PartKind kind;
  Turned turned;
  Towards towards;
  double degrees;  // the whole range of a person
};

constexpr Movement kMovements[] = {
    {"legs forward", PartKind::kLeg, Turned::kLimb, Towards::kFront, 120},
    {"legs back", PartKind::kLeg, Turned::kLimb, Towards::kBack, 30},
    {"legs aside", PartKind::kLeg, Turned::kLimb, Towards::kOutward, 45},
    {"knees", PartKind::kLeg, Turned::kMiddle, Towards::kBend, 135},
    {"ankles", PartKind::kLeg, Turned::kEnd, Towards::kDown, 50},
    {"arms up", PartKind::kArm, Turned::kLimb, Towards::kUp, 180},
    {"arms forward", PartKind::kArm, Turned::kLimb, Towards::kFront, 180},
    {"elbows", PartKind::kArm, Turned::kMiddle, Towards::kBend, 150},
    {"wrists", PartKind::kArm, Turned::kEnd, Towards::kDown, 80},
    {"trunk bent forward", PartKind::kTrunk, Turned::kAlong, Towards::kFront, 80},
    {"trunk bent aside", PartKind::kTrunk, Turned::kAlong, Towards::kLeft, 35},
    {"trunk turned", PartKind::kTrunk, Turned::kAlong, Towards::kTwist, 45},
    {"neck bent forward", PartKind::kNeck, Turned::kAlong, Towards::kFront, 45},
    {"neck bent aside", PartKind::kNeck, Turned::kAlong, Towards::kLeft, 45},
    {"head turned", PartKind::kHead, Turned::kLimb, Towards::kTwist, 60},
    {"tail up", PartKind::kTail, Turned::kAlong, Towards::kUp, 90},
    {"tail aside", PartKind::kTail, Turned::kAlong, Towards::kLeft, 90},
    {"wings up", PartKind::kWing, Turned::kAlong, Towards::kUp, 90},
    {"wings down", PartKind::kWing, Turned::kAlong, Towards::kDown, 90},
    {"fins back", PartKind::kFin, Turned::kAlong, Towards::kBack, 90},
};

struct Body {
  const Skeleton& skeleton;
  const Anatomy& anatomy;
  std::vector<Vec3> positions;  // #J, at rest
  std::vector<Quat> rotations;  // #J, of the joints' frames at rest
};

std::vector<Quat> restRotations(const Skeleton& skeleton) {
  std::vector<Quat> rotations;
  for (const Joint& joint : skeleton.joints) {
    rotations.push_back(joint.parent ? Quat(rotations[*joint.parent] * joint.rest.rotation) : joint.rest.rotation);
  }
  return rotations;
}

// Turns a joint, with all that hangs on it, about an axis in the space of the rest pose.
void turnJoint(const Body& body, Index joint, const Vec3& axis, double angle, Pose& pose) {
  const auto parent = body.skeleton.joints[joint].parent;
  const Quat frame = parent ? body.rotations[*parent] : Quat::Identity();
  const Quat turn(Eigen::AngleAxisd(angle, axis));
  Quat& local = pose.locals[joint].rotation;
  local = (frame.conjugate() * turn * frame * local).normalized();
}

// A unit vector about which `from` turns towards `to`.
std::optional<Vec3> axisBetween(const Vec3& from, const Vec3& to) {
  const Vec3 axis = from.cross(to);
  if (!(axis.norm() > kParallel * from.norm() * to.norm())) return std::nullopt;
  return axis.normalized();
}

Vec3 directionOf(const Axes& axes, Towards towards, Side side) {
  switch (towards) {
    case Towards::kBack:
      return -axes.front;
    case Towards::kUp:
      return axes.up;
    case Towards::kDown:
      return -axes.up;
    case Towards::kLeft:
      return axes.left();
    case Towards::kOutward:
      return side == Side::kRight ? Vec3(-axes.left()) : axes.left();
    default:
      return axes.front;
  }
}

// The joints from where a movement turns the part on.
std::span<const Index> jointsTurned(const Part& part, Turned turned) {
  const std::span<const Index> all = part.joints;
  const auto from = [&](std::optional<Index> joint) {
    for (std::size_t i = 0; joint && i < all.size(); ++i) {
      if (all[i] == *joint) return all.subspan(i);
    }
    return std::span<const Index>();
  };
  switch (turned) {
    case Turned::kLimb:
      return part.upper ? from(part.upper) : all;
    case Turned::kMiddle:
      return from(part.middle);
    case Turned::kEnd:
      return from(part.end);
    case Turned::kAlong:
      break;
  }
  // The trunk's first joint, the pelvis, would take legs and all along.
  return part.kind == PartKind::kTrunk && !all.empty() ? all.subspan(1) : all;
}

// Where a part goes on from its first turned joint: to its wrist or ankle, to its last joint, or on from the joint
// before.
Vec3 partDirection(const Body& body, const Part& part, std::span<const Index> joints) {
  const Index last = part.end && *part.end != joints.front() ? *part.end : joints.back();
  const Vec3 own = body.positions[last] - body.positions[joints.front()];
  const auto parent = body.skeleton.joints[joints.front()].parent;
  return own.norm() > 0 || !parent ? own : Vec3(body.positions[joints.front()] - body.positions[*parent]);
}

std::optional<Vec3> bendAxis(const Body& body, const Part& part, const Vec3& lower) {
  const Vec3 above = part.upper ? Vec3(body.positions[*part.middle] - body.positions[*part.upper]) : lower;
  const double sine = above.cross(lower).norm();
  if (std::atan2(sine, above.dot(lower)) > kStraight) return axisBetween(above, lower);
  const Vec3 front = body.anatomy.axes.front;
  return axisBetween(lower, part.kind == PartKind::kLeg ? Vec3(-front) : front);
}

// What a movement turns the part about; nothing where it points there already, or straight away.
std::optional<Vec3> turnAxis(const Body& body, const Part& part, Towards towards, const Vec3& direction) {
  if (towards == Towards::kTwist) return body.anatomy.axes.up;
  if (towards == Towards::kBend) return bendAxis(body, part, direction);
  return axisBetween(direction, directionOf(body.anatomy.axes, towards, part.side));
}

// Whether the part can do it.
bool movePart(const Body& body, const Part& part, const Movement& movement, Pose& pose) {
  const std::span<const Index> joints = jointsTurned(part, movement.turned);
  if (joints.empty()) return false;
  const std::optional<Vec3> axis = turnAxis(body, part, movement.towards, partDirection(body, part, joints));
  if (!axis) return false;
  const std::size_t count = movement.turned == Turned::kAlong ? joints.size() : 1;
  const double angle = kFraction * movement.degrees * kDegree / static_cast<double>(count);
  for (const Index joint : joints.first(count)) turnJoint(body, joint, *axis, angle, pose);
  return true;
}

}  // namespace

std::vector<RangeOfMotionPose> rangeOfMotion(const Skeleton& skeleton, const Anatomy& anatomy) {
  const Body body{skeleton, anatomy, restPositions(skeleton), restRotations(skeleton)};
  std::vector<RangeOfMotionPose> poses;
  for (const Movement& movement : kMovements) {
    Pose pose = restPose(skeleton);
    bool moves = false;
    for (const Part& part : anatomy.parts) {
      if (part.kind == movement.kind && movePart(body, part, movement, pose)) moves = true;
    }
    if (moves) poses.push_back({movement.name, std::move(pose)});
  }
  return poses;
}

}  // namespace limber
