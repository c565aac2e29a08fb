#include "limber/motion/limbs/limb_reach.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/core/text/numbers.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

struct KneeBend {
  // In leg lengths.
  // 0.005 to 0.02; added to a knee's bend forward; by jerk on the shared people, 0.02 before.
  double kneesForward = 0.01;
  // 0.05 to 0.2; a knee's bend backward from which on it is meant; set by hand.
  double overstretched = 0.12;
  // 0.01 to 0.05; joints that are less off the line to the end bend little; by jerk of a horse's clips on a dog (7.1
  // times the source's without it, 1.8 with it).
  double minLever = 0.02;
};
constexpr KneeBend kKneeBend;

// Of the sides of a triangle, opposite its third side.
double hingeAngle(double one, double other, double opposite) {
  const double cosine = (one * one + other * other - opposite * opposite) / (2 * one * other);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// The rotation of the hock, by the least sum of squared rotations that makes the leg as long as its goal requires, to
// first order: each joint turns the more the farther it is off the line to the end. It folds by its exact fraction of
// the change of length: at a hock that is nearly straight, first order would be too far. It approaches straight and
// folded the slower the nearer it comes.
Quat hockTurn(const LimbSpec& limb, const LimbShape& shape, const Vec3& there) {
  const Vec3 line = shape.end.normalized(), toStart = -shape.hock, toEnd = shape.end - shape.hock;
  const double off = toStart.cross(line).norm(), kneeOff = shape.middle.cross(line).norm();
  const Vec3 normal = toStart.cross(toEnd);
  if (normal.norm() < 1e-9 * limb.length * limb.length) return Quat::Identity();
  const double now = shape.end.norm(), longer = there.norm() - now, least = kKneeBend.minLever * limb.length;
  const double lever = off * off + kneeOff * kneeOff + least * least;
  const double angle = std::atan2(normal.norm(), toStart.dot(toEnd));
  double opens = off * longer / lever;
  if (opens < 0) opens = hingeAngle(toStart.norm(), toEnd.norm(), now + off * off / lever * longer) - angle;
  const double room = opens > 0 ? kPi - angle : angle;
  const double opened = std::copysign(room * (1 - std::exp(-std::abs(opens) / room)), opens);
  return Quat(Eigen::AngleAxisd(opened, normal.normalized()));
}

// Where the joint angles have the middle joint, but forward where it hardly bends.
Vec3 jointsBend(const LimbSpec& limb, const LimbShape& shape) {
  const Vec3& line = shape.line;
  const Vec3 forward = (shape.ahead - shape.ahead.dot(line) * line).normalized();
  const Vec3 bend = shape.middle - shape.middle.dot(line) * line;
  const double backward = std::max(-bend.dot(forward), 0.0);
  const double little = std::max(1 - backward / (kKneeBend.overstretched * limb.length), 0.0);
  return bend + little * (backward + kKneeBend.kneesForward * limb.length) * forward;
}

// As at rest, seen from the body: the leg's own upper joint turns past the direction to the end where the source's
// bends far elsewhere.
Vec3 ownBend(const LimbShape& shape) {
  return shortestRotation(shape.neutralEnd, shape.line) * shape.neutralAhead;
}

// Seen from the direction to the goal: of a leg that is nearly straight, the knee itself may lie on its other side.
Vec3 kneePole(const LimbShape& shape, const Vec3& there) {
  return 0.5 * there + shortestRotation(shape.line, there) * shape.bend;
}

}  // namespace

void LimbShape::findBend(const LimbSpec& limb) {
  line = end.normalized();
  bend = limb.ownBend ? ownBend(*this) : jointsBend(limb, *this);
}

bool LimbReach::isThere(const LimbSpec& limb, const LimbGoal& goal, const BodyFrame& frame) {
  return (goal.position - frame.positions[limb.end]).norm() < 1e-9 * limb.length && goal.turn.w() == 1;
}

void LimbReach::reach(const LimbSpec& limb, const LimbGoal& goal, BodyFrame& frame, Pose& target) const {
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat orientation = goal.turn * frame.rotations[limb.end];
  LimbShape shape = shapeOf(limb, frame);
  const Vec3 there = goal.position - frame.positions[limb.upper];
  if (limb.hock) {
    const Quat turned = hockTurn(limb, shape, there) * frame.rotations[*limb.hock];
    target.locals[*limb.hock].rotation =
        (kinematics.parentRotation(*limb.hock, frame).conjugate() * turned).normalized();
    kinematics.globalsBelow(*limb.hock, target, frame);
    if (root_.carrierOf(limb.end) != limb.end) root_.settleLoose(target, frame);
    shape.middle = frame.positions[limb.lower] - frame.positions[limb.upper];
    shape.end = frame.positions[limb.end] - frame.positions[limb.upper];
    shape.findBend(limb);
  }
  TwoBone bones{Vec3::Zero(), shape.middle, shape.end, there, {}, {}};
  if (limb.kneeAhead) bones.pole = kneePole(shape, there);
  const TwoBoneTurns turns = solveTwoBone(bones);
  const Quat aboveUpper = kinematics.parentRotation(limb.upper, frame);
  const Quat aboveLower = turns.start * kinematics.parentRotation(limb.lower, frame);
  target.locals[limb.upper].rotation =
      (aboveUpper.conjugate() * turns.start * frame.rotations[limb.upper]).normalized();
  target.locals[limb.lower].rotation =
      (aboveLower.conjugate() * turns.middle * frame.rotations[limb.lower]).normalized();
  kinematics.globalsBelow(limb.upper, target, frame);
  turnEnd(limb.end, orientation, frame, target);
}

LimbShape LimbReach::shapeOf(const LimbSpec& limb, const BodyFrame& frame) const {
  const Vec3 kneeAhead = limb.kneeAhead.value_or(Vec3::UnitZ());
  const Vec3& start = frame.positions[limb.upper];
  LimbShape shape;
  shape.middle = frame.positions[limb.lower] - start;
  shape.end = frame.positions[limb.end] - start;
  shape.hock = frame.positions[limb.hock.value_or(limb.lower)] - start;
  shape.hockCarriesMiddle = limb.hock && isAncestorOrSelf(*setup_.target, *limb.hock, limb.lower);
  shape.ahead = turnOf(limb.upper, frame) * kneeAhead;
  if (limb.ownBend) {
    const std::vector<Vec3>& neutral = setup_.targetNeutral.positions;
    const std::optional<Index> body = setup_.target->joints[limb.upper].parent;
    const Quat turn = body ? turnOf(*body, frame) : Quat::Identity();
    shape.neutralEnd = turn * (neutral[limb.end] - neutral[limb.upper]);
    shape.neutralAhead = turn * kneeAhead;
  }
  shape.findBend(limb);
  return shape;
}

TwoBonePositions LimbReach::positionsFor(const LimbSpec& limb, LimbShape shape, const Vec3& there) {
  if (limb.hock) {
    const Quat turn = hockTurn(limb, shape, there);
    shape.end = shape.hock + turn * (shape.end - shape.hock);
    if (shape.hockCarriesMiddle) shape.middle = shape.hock + turn * (shape.middle - shape.hock);
    shape.findBend(limb);
  }
  TwoBone bones{Vec3::Zero(), shape.middle, shape.end, there, {}, {}};
  bones.pole = kneePole(shape, there);
  return twoBonePositions(bones);
}

void LimbReach::turnEnd(Index end, const Quat& orientation, BodyFrame& frame, Pose& target) const {
  const BodyKinematics& kinematics = setup_.targetKinematics;
  target.locals[end].rotation = (kinematics.parentRotation(end, frame).conjugate() * orientation).normalized();
  kinematics.globalsBelow(end, target, frame);
  root_.settleLoose(target, frame);
}

Quat LimbReach::turnOf(Index joint, const BodyFrame& frame) const {
  return frame.rotations[joint] * setup_.targetNeutral.rotations[joint].conjugate();
}

}  // namespace limber
