// How far a joint may turn or slide, and the nearest allowed state to any other.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "limber/core/transform.h"

namespace limber {

// All limits speak of a joint's rotation in its limit's own axes: Y along the bone (the twist axis), X and Z across.
// Angles in radians, lengths in metres.

// min <= max; at most one turn wide; whole turns do not matter.
struct AngleRange {
  double min = 0, max = 0;
};

// Turns in every direction.
struct FreeJoint {};
// Does not turn.
struct FixedJoint {};
// Turns about X only: elbow, finger.
struct Hinge {
  AngleRange x;
};
// Turns about Y only: the neck's atlas, a wheel.
struct Pivot {
  AngleRange y;
};
// Swings within an elliptic cone and twists about the bone: shoulder, hip. The cone's edge is made of four quarter
// ellipses in the plane of the swing's rotation vector, with half axes x.max and -x.min, z.max and -z.min; each
// between 0 and pi.
struct BallAndSocket {
  AngleRange x, z;
  AngleRange twist;
};
// Swings within an elliptic cone, without twist: wrist.
struct Condyloid {
  AngleRange x, z;
};
// Two hinges, one upon the other: first about Z, then about the X carried along; no twist of its own: the thumb's root.
struct Saddle {
  AngleRange x, z;
};
// Swings about X and Z, each within its own range (a box in the plane of the swing's rotation vector, within +-pi), and
// twists: the spine's joints, forearm.
struct SwingTwist {
  AngleRange x, z, twist;
};
// The bone stays within a polygon of great-circle arcs that is star-shaped seen from `center` (Wilhelms, Van Gelder:
// Fast and Easy Reach-Cone Joint Limits, 2001), and twists. Directions of the bone, of any length but 0, in the limit's
// axes, in order counter-clockwise seen from outside the sphere; each less than 90 degrees from `center`.
struct ReachCone {
  Vec3 center = Vec3::UnitY();
  std::vector<Vec3> polygon;
  AngleRange twist;
};
// Slides across the bone by offsets along X and Z in metres, and does not turn: between the bones of the wrist.
struct PlaneJoint {
  AngleRange x, z;
};

using JointMotion = std::variant<FreeJoint, FixedJoint, Hinge, Pivot, BallAndSocket, Condyloid, Saddle, SwingTwist,
                                 ReachCone, PlaneJoint>;

// The local rotation is neutral * axes * r * axes^-1, with r what the motion limits. For a PlaneJoint the translation
// is rest + neutral * axes * (x, 0, z).
struct JointLimit {
  JointMotion motion = FreeJoint{};
  Quat neutral = Quat::Identity();      // the local rotation at which every angle is 0, often that of the rest pose
  Quat axes = Quat::Identity();         // the limit's axes in the joint's own frame
  Vec3 restTranslation = Vec3::Zero();  // of a PlaneJoint, in the parent's frame
  double stiffness = 0;                 // 0 to 1: how unwilling a solver is to move this joint; at 1 it does not
};

// #J, one for each joint of a skeleton.
struct JointLimits {
  std::vector<JointLimit> joints;
};

// Throws Error kBadData, `where` in front: ranges upside down or too wide, axes not of unit length, polygons that are
// not star-shaped, numbers not finite.
void checkLimit(const JointLimit& limit, const std::string& where);

// The nearest local rotation that the limit allows; `local` itself, bit for bit, where it is allowed (to 1e-12).
// Nearest means: for Hinge, Pivot and Saddle by the angle between rotations; for ReachCone by the angle between bone
// directions and between twists; for the others in the plane of the swing's rotation vector and by the angle between
// twists. Continuous, except where two allowed rotations are equally near. Cost: 20 to 200 ns.
Quat nearestAllowed(const JointLimit& limit, const Quat& local);
// The same for the translation; it is free to change only for a PlaneJoint, and left alone elsewhere.
Vec3 nearestAllowedTranslation(const JointLimit& limit, const Vec3& local);

// The angle between a local rotation and the nearest allowed one.
double limitViolation(const JointLimit& limit, const Quat& local);

// The axes about which an allowed rotation may go on turning while it stays allowed or meets an edge, in the joint's
// current frame; the first `count` of three. Edges do not count: a joint at its bound keeps its axes.
struct TurnAxes {
  std::array<Vec3, 3> axes;
  int count = 0;
};
TurnAxes turnAxes(const JointLimit& limit, const Quat& local);

// A rotation from three numbers in [0, 1]: anything that the limit allows can come out, all of it about equally likely.
Quat allowedRotation(const JointLimit& limit, const Vec3& uniform);

// The point of a curve of four quarter ellipses (half axes as in BallAndSocket) nearest to (x, z), or the point itself
// where it lies inside. Exact to rounding.
Eigen::Vector2d nearestInEllipses(const AngleRange& x, const AngleRange& z, const Eigen::Vector2d& point);

// The direction within the reach cone nearest to the unit vector `direction`.
Vec3 nearestInReachCone(const ReachCone& cone, const Vec3& direction);

}  // namespace limber
