#include "limber/retarget/limb_reach.h"

#include <algorithm>

#include "limber/ik/rotation.h"

namespace limber {

namespace {

constexpr double kKneesForward = 0.01;   // of the leg's length, added to its bend
constexpr double kOverstretched = 0.12;  // likewise, of a knee that is meant to bend backward

}  // namespace

bool LimbReach::isThere(const Limb& limb, const BodyFrame& frame) {
  return (limb.goal - frame.positions[limb.end]).norm() < 1e-9 * limb.length && limb.turn.w() == 1;
}

void LimbReach::reach(const Limb& limb, const Vec3* kneeAhead, BodyFrame& frame, Pose& target) const {
  const Quat orientation = limb.turn * frame.rotations[limb.end];
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

void LimbReach::turnEnd(const Limb& limb, const Quat& orientation, BodyFrame& frame, Pose& target) const {
  const BodyKinematics& kinematics = setup_.targetKinematics;
  target.locals[limb.end].rotation =
      (kinematics.parentRotation(limb.end, frame).conjugate() * orientation).normalized();
  kinematics.globals(target, frame);
  root_.settle(target, frame);
}

Vec3 LimbReach::kneePole(const Limb& limb, const TwoBone& bones, const Vec3& kneeAhead, const BodyFrame& frame) const {
  const Vec3 way = (bones.end - bones.start).normalized(), knee = bones.middle - bones.start;
  const Quat turn = frame.rotations[limb.upper] * setup_.targetNeutral.rotations[limb.upper].conjugate();
  const Vec3 ahead = turn * kneeAhead, forward = (ahead - ahead.dot(way) * way).normalized();
  Vec3 bend = knee - knee.dot(way) * way;
  const double backward = std::max(-bend.dot(forward), 0.0);
  const double little = std::max(1 - backward / (kOverstretched * limb.length), 0.0);
  bend += little * (backward + kKneesForward * limb.length) * forward;
  // Seen from the way to the goal: of a leg that is nearly straight, the knee itself may lie on its other side.
  const Vec3 there = bones.target - bones.start;
  return bones.start + 0.5 * there + shortestRotation(way, there) * bend;
}

}  // namespace limber
