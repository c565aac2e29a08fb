#include "limber/motion/limbs/body/pelvis.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

struct PelvisValues {
  // Exponent; 1 to 2; of the hips' widths, by which the rotations of wider hips are less; set by hand.
  double widthPower = 1.5;

  // In hip heights of the target.
  double softChange = 0.004;  // 0.002 to 0.01; displacement of a foot that counts half; by jerk on people
  // 0.05 to 0.2; by which foot-driven legs count e times as much if they want the body lower; set by hand on farm
  // animals.
  double softBend = 0.1;
  double stanceBelow = 0.45;  // LimbState::lift; 0.3 to kLifted; their bend no longer counts; set by hand
  double softFold = 0.02;     // 0.01 to 0.05; before a leg folds wholly; set by hand

  double stay = 0.5;  // legs; 0.1 to 1; that want the body to stay, against foot-driven ones; set by hand
  // Fraction; 0.5 to 1; of what the bends of legs at both ends want these to move apart; at 1 a fox that gallops as an
  // alpaca reared.
  double apart = 0.75;
  // Fraction of the distance to which a leg folds; 0.2 to 1; how far below its hip the pose has a foot that wholly
  // keeps the body above it (less up to the hip's level); on handstands, kicks and raised legs: bones off by 14
  // degrees, not 180.
  double clearlyBelow = 0.5;
  // Stiffness against rotation by planted legs, leg lengths: 0.05 to 0.5 both, more on one leg; its bound, radians: 0.4
  // to 1.2. By jerk on toys with wide hips (3.3 -> 1.6 times the source's at worst).
  double stiffOnTwo = 0.15, stiffOnOne = 0.3, maxTurn = 0.8;
};
constexpr PelvisValues kValues;

// x where it is small, at most `most` in either direction.
double saturated(double x, double most) {
  const double fraction = x / most;
  return x / std::sqrt(std::sqrt(1 + fraction * fraction * fraction * fraction));
}

// Fraction to which the body makes up for what the leg lacks to reach its goal.
double followed(const LimbState& leg) {
  return leg.upright * smoothStep(1 - leg.lift / kLifted);
}

double hipWidth(const NeutralPose& neutral, Index left, Index right) {
  return (neutral.restPositions[left] - neutral.restPositions[right]).norm();
}

}  // namespace

Pelvis::Pelvis(const RetargetSetup& setup, const RootPositioner& root)
    : setup_(setup), root_(root), tilt_(setup, root) {
  if (!setup.person) return;
  const JointMatch &left = *setup.map.find(body_part::leg(Side::kLeft, Segment::kUpper)),
                   &right = *setup.map.find(body_part::leg(Side::kRight, Segment::kUpper));
  leftHip_ = left.target.front();
  rightHip_ = right.target.front();
  const double wide = hipWidth(setup.targetNeutral, leftHip_, rightHip_) / setup.targetHipHeight;
  const double source =
      hipWidth(setup.sourceNeutral, left.source.front(), right.source.front()) / setup.sourceHipHeight;
  if (source > 0 && wide > source) hipTurns_ = std::pow(source / wide, kValues.widthPower);
  if (const JointMatch* trunk = setup.map.find(body_part::kTrunk)) trunk_ = trunk->target.back();
}

void Pelvis::levelHips(Pose& target, BodyFrame& frame) const {
  if (hipTurns_ == 1) return;
  const NeutralPose& neutral = setup_.targetNeutral;
  const Vec3 line = (frame.positions[leftHip_] - frame.positions[rightHip_]).normalized();
  Vec3 levelled = alongGround(line);
  if (trunk_) {
    const Vec3 restDirection = (neutral.positions[leftHip_] - neutral.positions[rightHip_]).normalized();
    levelled = 0.5 * (levelled +
                      alongGround(frame.rotations[*trunk_] * neutral.rotations[*trunk_].conjugate() * restDirection));
  }
  levelled += (1 - levelled.norm()) * line;
  const Vec3 goal = (hipTurns_ * line + (1 - hipTurns_) * levelled).normalized();
  root_.turnPelvis(shortestRotation(line, goal), target, frame);
}

Pelvis::Move Pelvis::moveFor(std::span<const Leg> legs, const BodyFrame& frame, std::optional<double> rise) const {
  if (tilt_.tilts()) {
    const auto fore = std::find_if(legs.begin(), legs.end(), [](const Leg& leg) { return leg.spec.fore; });
    const auto hind = static_cast<std::size_t>(fore - legs.begin());
    return moveOfEnds(legs.first(hind), legs.subspan(hind), frame);
  }
  const Quat turn = turnFor(legs, frame);
  return {turn, shiftFor(legs, frame, turn, rise ? *rise : riseFor(legs, frame, turn))};
}

Pelvis::Move Pelvis::moveOfEnds(std::span<const Leg> hind, std::span<const Leg> fore, const BodyFrame& frame) const {
  const Quat none = Quat::Identity();
  const double hindRise = riseFor(hind, frame, none), foreRise = riseFor(fore, frame, none);
  const double apart = 0.5 * (1 - kValues.apart) * (foreRise - hindRise);
  const double up = shiftFor(hind, frame, none, hindRise + apart);
  return {TrunkTilt::turnFor(shiftFor(fore, frame, none, foreRise - apart) - up, tilt_.trunkOf(frame)), up};
}

Vec3 Pelvis::hipDisplacement(const Move& move, const LegSpec& leg, const BodyFrame& frame) const {
  const Vec3 displacement = Vec3(0, move.up, 0);
  if (move.turn.w() == 1) return displacement;
  const Vec3 fromMiddle = frame.positions[leg.upper] - root_.middleOfHips(frame);
  return displacement + move.turn * fromMiddle - fromMiddle;
}

void Pelvis::apply(const Move& move, Pose& target, BodyFrame& frame) const {
  root_.turnPelvis(move.turn, target, frame);
  if (std::abs(move.up) > 1e-9 * setup_.targetHipHeight) {
    root_.movePelvis(Vec3(0, move.up, 0), target, frame);
  } else if (!root_.turnsPelvis()) {  // else turning it did that
    root_.settle(target, frame);
  }
}

// Least squares over what the planted legs lack, against the turn itself. On one leg only the turn about the vertical
// helps: the shift brings that leg to the ground.
Quat Pelvis::turnFor(std::span<const Leg> legs, const BodyFrame& frame) const {
  if (legs.size() != 2 || !root_.turnsPelvis() || legs[0].spec.drive || legs[1].spec.drive) return Quat::Identity();
  const Leg &left = legs[0], &right = legs[1];
  const Vec3 toHip = 0.5 * (frame.positions[left.spec.upper] - frame.positions[right.spec.upper]);
  const Vec3 lackLeft = left.goal.position - frame.positions[left.spec.end],
             lackRight = right.goal.position - frame.positions[right.spec.end];
  const double both = left.state.contact.strength * right.state.contact.strength,
               length = 0.5 * (left.spec.length + right.spec.length);
  const double onTwo = kValues.stiffOnTwo * length, onOne = kValues.stiffOnOne * length;
  Vec3 turn = 0.5 * both / (toHip.squaredNorm() + onTwo * onTwo) * toHip.cross(lackLeft - lackRight);
  const Vec3 alone =
      (left.state.contact.strength - both) * lackLeft - (right.state.contact.strength - both) * lackRight;
  turn.y() += toHip.cross(alone).y() / (toHip.squaredNorm() + onOne * onOne);
  return fromRotationVector(turn / std::sqrt(1 + turn.squaredNorm() / (kValues.maxTurn * kValues.maxTurn)));
}

// The rise of the pelvis with which every planted leg would be as long as its joint angles make it: the weighted mean
// over the legs. The more level a leg is, the less rising does to its length, and the less it counts.
double Pelvis::riseFor(std::span<const Leg> legs, const BodyFrame& frame, const Quat& turn) const {
  double sum = 0, weights = 0;
  for (const Leg& leg : legs) {
    if (leg.spec.drive) continue;
    const Vec3 hip = frame.positions[leg.spec.upper],
               displacement = leg.goal.position - hip - hipDisplacement({turn, 0}, leg.spec, frame);
    const double length = (frame.positions[leg.spec.end] - hip).norm(),
                 across = std::hypot(displacement.x(), displacement.z());
    if (displacement.y() >= 0 || across >= length) continue;
    const double weight = leg.state.contact.strength * (1 - across * across / (length * length));
    sum += weight * (displacement.y() + std::sqrt(length * length - across * across));
    weights += weight;
  }
  const double most = kMaxSink * setup_.targetHipHeight;
  return std::clamp(sum / std::max(weights, 1.0) + footDrivenOffset(legs, frame), -most, most);
}

// These legs' joint angles have the foot elsewhere: legs in stance bend as the source's do. A mean of the rises,
// without a kink where another leg takes over.
double Pelvis::footDrivenOffset(std::span<const Leg> legs, const BodyFrame& frame) const {
  const double soft = kValues.softBend * setup_.targetHipHeight;
  double sum = kValues.stay, weights = kValues.stay;
  for (const Leg& leg : legs) {
    if (!leg.spec.drive) continue;
    const Vec3 displacement = leg.goal.position - frame.positions[leg.spec.upper];
    const double reach = leg.state.bentReach, across = std::hypot(displacement.x(), displacement.z());
    if (across >= reach) continue;
    const double weight = leg.state.upright * smoothStep(1 - leg.state.lift / kValues.stanceBelow) *
                          (1 - across * across / (reach * reach)) * steepness(leg.spec.support, across, reach);
    const double up = displacement.y() + std::sqrt(reach * reach - across * across);
    sum += weight * std::exp(-saturated(up, kMaxSink * setup_.targetHipHeight) / soft);
    weights += weight;
  }
  return -soft * std::log(sum / weights);
}

// A foot-driven leg may be led so far ahead that a person's leg is nearly level: then the body lets go of it.
double Pelvis::steepness(const BodySupport& support, double across, double reach) {
  if (!(support.nearLevel > 0)) return 1;
  return smoothStep((1 - across * across / (reach * reach)) / support.nearLevel);
}

double Pelvis::changeOf(const Leg& leg, const BodyFrame& frame, const Quat& turn) const {
  if (leg.spec.drive) return 1;
  const double change =
      (leg.goal.position - frame.positions[leg.spec.end] - hipDisplacement({turn, 0}, leg.spec, frame)).norm();
  return change / (change + kValues.softChange * setup_.targetHipHeight);
}

double Pelvis::shiftFor(std::span<const Leg> legs, const BodyFrame& frame, const Quat& turn, double rise) const {
  if (legs.empty()) return rise;
  const double height = setup_.targetHipHeight;
  double sum = 0;
  for (const Leg& leg : legs) {
    const BodySupport& support = leg.spec.support;
    const Vec3 hipGoes = hipDisplacement({turn, 0}, leg.spec, frame);
    const Vec3 displacement = leg.goal.position - frame.positions[leg.spec.upper] - hipGoes - Vec3(0, rise, 0);
    if (displacement.y() >= 0) continue;
    const double length = kMaxStretch * leg.spec.length, across = std::hypot(displacement.x(), displacement.z());
    const double down = std::sqrt(std::max(length * length - across * across, 0.0));
    const double soft = support.softStretch * height;
    const double needed = followed(leg.state) * steepness(support, across, length) *
                          softPositive(-displacement.y() - down, soft * leg.state.changed);
    sum += needed * needed * needed * needed;
  }
  // The most that a leg asks for, but without a kink where another takes over.
  const BodySupport& support = legs.front().spec.support;
  const double most = std::sqrt(std::sqrt(sum)), bound = support.maxSink * height;
  const double shift = rise - (support.sinksSoftly ? saturated(most, bound) : std::min(most, bound));
  return shift + raiseFor(legs, frame, shift);
}

// So that no planted foot of a foot-driven leg is nearer to its hip than the leg folds, where it would go astray,
// nor a person's further than knees do, which else turn round. That is for legs which the pose has below their hips,
// though goals may lie above these (of a body that comes out of the ground): the hip has to rise over the goal. A foot
// that the pose has above its hip (a handstand, a high kick, legs that point up) is to stay there.
double Pelvis::raiseFor(std::span<const Leg> legs, const BodyFrame& frame, double shift) const {
  double sum = 0;
  for (const auto& [spec, state, goal] : legs) {
    const Vec3 displacement = goal.position - frame.positions[spec.upper] - Vec3(0, shift, 0);
    const Vec3 own = (spec.drive ? state.position : frame.positions[spec.end]) - frame.positions[spec.upper];
    const double least = spec.drive ? spec.support.nearest : std::min(spec.support.nearest, own.norm());
    const double across = std::hypot(displacement.x(), displacement.z());
    if (across >= least) continue;
    const double lacks = std::sqrt(least * least - across * across) + displacement.y();
    const double below = smoothStep(-own.y() / (kValues.clearlyBelow * least));
    const double needed = below * followed(state) * softPositive(lacks, kValues.softFold * setup_.targetHipHeight);
    sum += needed * needed * needed * needed;
  }
  return std::sqrt(std::sqrt(sum));
}

}  // namespace limber
