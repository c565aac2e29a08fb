#include "limber/limbs/limb_reach.h"

#include <algorithm>
#include <cmath>

#include "limber/core/numbers.h"
#include "limber/ik/rotation.h"

namespace limber {

namespace {

constexpr double kKneesForward = 0.01;   // of the leg's length, added to its bend
constexpr double kOverstretched = 0.12;  // likewise, of a knee that is meant to bend backward
constexpr double kLeastLever = 0.02;     // likewise: joints that are hardly off the line to the end bend little

// Where the joint angles have the middle joint, but forward where it hardly bends.
Vec3 bendOf(const Limb& limb, const TwoBone& bones, const Vec3& way, const Vec3& forward) {
  const Vec3 knee = bones.middle - bones.start, bend = knee - knee.dot(way) * way;
  const double backward = std::max(-bend.dot(forward), 0.0);
  const double little = std::max(1 - backward / (kOverstretched * limb.length), 0.0);
  return bend + little * (backward + kKneesForward * limb.length) * forward;
}

// Of the sides of a triangle, opposite its third side.
double hingeAngle(double one, double other, double opposite) {
  const double cosine = (one * one + other * other - opposite * opposite) / (2 * one * other);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

bool LimbReach::isThere(const Limb& limb, const BodyFrame& frame) {
  return (limb.goal - frame.positions[limb.end]).norm() < 1e-9 * limb.length && limb.turn.w() == 1;
}

void LimbReach::reach(const Limb& limb, const Vec3* kneeAhead, BodyFrame& frame, Pose& target) const {
  const Quat orientation = limb.turn * frame.rotations[limb.end];
  if (limb.hock) bendHock(limb, frame, target);
  TwoBone bones{frame.positions[limb.upper], frame.positions[limb.lower], frame.positions[limb.end], limb.goal, {}, {}};
  if (kneeAhead) bones.pole = kneePole(limb, bones, *kneeAhead, frame);
  const TwoBoneTurns turns = solveTwoBone(bones);
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat aboveUpper = kinematics.parentRotation(limb.upper, frame);
  const Quat aboveLower = turns.start * kinematics.parentRotation(limb.lower, frame);
  target.locals[limb.upper].rotation =
      (aboveUpper.conjugate() * turns.start * frame.rotations[limb.upper]).normalized();
  target.locals[limb.lower].rotation =
      (aboveLower.conjugate() * turns.middle * frame.rotations[limb.lower]).normalized();
  kinematics.globals(target, frame);
  turnEnd(limb, orientation, frame, target);
}

// The least sum of squared turns that makes the leg as long as its goal asks, to first order: each joint turns the more
// the farther it is off the line to the end. It folds as far as its share of the way takes: at a hock that is nearly
// straight, first order would be too far. Towards straight and folded it comes the nearer the slower.
void LimbReach::bendHock(const Limb& limb, BodyFrame& frame, Pose& target) const {
  const Vec3 start = frame.positions[limb.upper], leg = frame.positions[limb.end] - start, line = leg.normalized();
  const Vec3 hock = frame.positions[*limb.hock], toStart = start - hock, toEnd = frame.positions[limb.end] - hock;
  const double off = toStart.cross(line).norm(), kneeOff = (frame.positions[limb.lower] - start).cross(line).norm();
  const Vec3 normal = toStart.cross(toEnd);
  if (normal.norm() < 1e-9 * limb.length * limb.length) return;
  const double longer = (limb.goal - start).norm() - leg.norm(), least = kLeastLever * limb.length;
  const double lever = off * off + kneeOff * kneeOff + least * least;
  const double angle = std::atan2(normal.norm(), toStart.dot(toEnd));
  double opens = off * longer / lever;
  if (opens < 0) opens = hingeAngle(toStart.norm(), toEnd.norm(), leg.norm() + off * off / lever * longer) - angle;
  const double room = opens > 0 ? kPi - angle : angle;
  const double opened = std::copysign(room * (1 - std::exp(-std::abs(opens) / room)), opens);
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat turned = Eigen::AngleAxisd(opened, normal.normalized()) * frame.rotations[*limb.hock];
  target.locals[*limb.hock].rotation = (kinematics.parentRotation(*limb.hock, frame).conjugate() * turned).normalized();
  kinematics.globals(target, frame);
  if (root_.carrierOf(limb.end) != limb.end) root_.settle(target, frame);
}

void LimbReach::turnEnd(const Limb& limb, const Quat& orientation, BodyFrame& frame, Pose& target) const {
  const BodyKinematics& kinematics = setup_.targetKinematics;
  target.locals[limb.end].rotation =
      (kinematics.parentRotation(limb.end, frame).conjugate() * orientation).normalized();
  kinematics.globals(target, frame);
  root_.settle(target, frame);
}

Vec3 LimbReach::kneePole(const Limb& limb, const TwoBone& bones, const Vec3& kneeAhead, const BodyFrame& frame) const {
  const Vec3 way = (bones.end - bones.start).normalized();
  const Vec3 ahead = turnOf(limb.upper, frame) * kneeAhead, forward = (ahead - ahead.dot(way) * way).normalized();
  const Vec3 bend = limb.ownBend ? ownBend(limb, way, kneeAhead, frame) : bendOf(limb, bones, way, forward);
  // Seen from the way to the goal: of a leg that is nearly straight, the knee itself may lie on its other side.
  const Vec3 there = bones.target - bones.start;
  return bones.start + 0.5 * there + shortestRotation(way, there) * bend;
}

// As at rest, seen from the body: the leg's own upper joint turns past the way where the source's bends far elsewhere.
Vec3 LimbReach::ownBend(const Limb& limb, const Vec3& way, const Vec3& kneeAhead, const BodyFrame& frame) const {
  const std::vector<Vec3>& neutral = setup_.targetNeutral.positions;
  const std::optional<Index> body = setup_.target->joints[limb.upper].parent;
  const Quat turn = body ? turnOf(*body, frame) : Quat::Identity();
  return shortestRotation(turn * (neutral[limb.end] - neutral[limb.upper]), way) * (turn * kneeAhead);
}

Quat LimbReach::turnOf(Index joint, const BodyFrame& frame) const {
  return frame.rotations[joint] * setup_.targetNeutral.rotations[joint].conjugate();
}

}  // namespace limber
