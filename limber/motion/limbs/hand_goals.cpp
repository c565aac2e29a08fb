#include "limber/motion/limbs/hand_goals.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

// Distances at which a hand touches wholly and not at all: from the other hand, forearms; from the middle of the head
// and of the trunk, distances of the shoulders; from a thigh's and a forearm's bone, their lengths. From the radius
// there to three times it: an adult's chest is about 0.3 shoulder distances deep before and behind its middle, a thigh
// 0.16 of its length, a forearm 0.13; the wrist is half a hand's thickness above what the palm lies on. By the judge on
// half of the shared motions: hands on hips 24 -> 28 of 28, crossed arms 21 -> 28 of 30.
constexpr TouchDistances kHands = {0.46, 0.8}, kHead = {0.33, 0.6}, kTrunk = {0.37, 0.53}, kThigh = {0.21, 0.29},
                         kForearm = {0.23, 0.46};
struct Reaching {
  // Arm lengths; 0.9 to kMaxStretch; from there on stretching softens; by jerk on the shared motions.
  double softReach = 0.96;
  // By whole motions of boxing and bending, in which arms flipped:
  double softFold = 0.45;  // arm lengths; 0.3 to 0.6; below it, and below the pose's own, folding softens
  double fold = 0.6;       // fraction of that; 0.3 to 0.9; nearest of a hand to its shoulder: else elbows snap
  double maxTouch = 0.5;   // arm lengths; 0.2 to 1; displacement of a hand from its joint angles
};
constexpr Reaching kReaching;

// `distance` beyond `edge`, but the slower the nearer it comes to `end`.
double towards(double end, double edge, double distance) {
  const double room = end - edge, over = distance - edge;
  return room * over > 0 ? edge + room * (1 - std::exp(-over / room)) : edge;
}

double closeness(double distance, const TouchDistances& of) {
  return smoothStep((of.apart - distance) / (of.apart - of.touching));
}

// Short displacements stay about as they are.
Vec3 atMost(const Vec3& displacement, double most) {
  return displacement / std::pow(1 + std::pow(displacement.norm() / most, 8), 1.0 / 8);
}

}  // namespace

HandGoals::HandGoals(const RetargetSetup& setup, const RootPositioner& root) : setup_(setup) {
  using body_part::arm;
  using body_part::leg;
  const Gauge shoulders = gaugeOf(arm(Side::kLeft, Segment::kUpper), arm(Side::kRight, Segment::kUpper));
  hands_ = gaugeOf(arm(Side::kLeft, Segment::kMiddle), arm(Side::kLeft, Segment::kEnd));
  for (const Side side : kSides) {
    const auto limb = findArm(setup_, root, side);
    if (!limb) continue;
    arms_.push_back({*limb, {}});
    const Side other = opposite(side);
    std::vector<Surface>& surfaces = surfaces_.emplace_back();
    const auto add = [&](const BodyPart& from, const BodyPart& to, const Gauge& gauge, const TouchDistances& at) {
      addSurface(from, to, gauge, at, surfaces);
    };
    add(body_part::kHead, body_part::kHead, shoulders, kHead);
    add(body_part::kPelvis, body_part::kNeck, shoulders, kTrunk);
    for (const Side thigh : kSides) {
      const BodyPart hip = leg(thigh, Segment::kUpper), knee = leg(thigh, Segment::kMiddle);
      add(hip, knee, gaugeOf(hip, knee), kThigh);
    }
    const BodyPart elbow = arm(other, Segment::kMiddle), hand = arm(other, Segment::kEnd);
    add(elbow, hand, gaugeOf(elbow, hand), kForearm);
  }
}

HandGoals::Gauge HandGoals::gaugeOf(const BodyPart& from, const BodyPart& to) const {
  const Gauge hips = {setup_.sourceHipHeight, setup_.targetHipHeight};
  const JointMatch *begin = setup_.map.find(from), *end = setup_.map.find(to);
  if (!begin || !end) return hips;
  const auto length = [](const NeutralPose& body, Index a, Index b) {
    return (body.restPositions[b] - body.restPositions[a]).norm();
  };
  const Gauge gauge = {length(setup_.sourceNeutral, begin->source.front(), end->source.front()),
                       length(setup_.targetNeutral, begin->target.front(), end->target.front())};
  return gauge.source > 0 ? gauge : hips;
}

void HandGoals::addSurface(const BodyPart& from, const BodyPart& to, const Gauge& gauge,
                           const TouchDistances& distances, std::vector<Surface>& surfaces) const {
  const JointMatch *begin = setup_.map.find(from), *end = setup_.map.find(to);
  if (!begin || !end) return;
  surfaces.push_back(
      {{begin->source.front(), end->source.front()}, {begin->target.front(), end->target.front()}, gauge, distances});
}

// Where touches want the hand, against where it is.
Vec3 HandGoals::touchOf(const Arm& arm, const std::vector<Surface>& surfaces, const BodyFrame& source,
                        const BodyFrame& target) const {
  const Vec3 hand = source.positions[arm.spec.sourceEnd];
  Vec3 sum = Vec3::Zero();
  double weights = 0, missing = 1;
  for (const Surface& surface : surfaces) {
    const Vec3 begin = source.positions[surface.source[0]], bone = source.positions[surface.source[1]] - begin;
    const double along =
        bone.squaredNorm() > 0 ? std::clamp((hand - begin).dot(bone) / bone.squaredNorm(), 0.0, 1.0) : 0;
    const Vec3 away = (hand - begin - along * bone) / surface.gauge.source;
    const Vec3 from = target.positions[surface.target[0]], to = target.positions[surface.target[1]];
    const double weight = closeness(away.norm(), surface.distances);
    sum += weight * (from + along * (to - from) + surface.gauge.target * away - arm.goal.position);
    weights += weight;
    missing *= 1 - weight;
  }
  return weights > 0 ? Vec3((1 - missing) / weights * sum) : sum;
}

void HandGoals::softenReach(Arm& arm, const BodyFrame& target) const {
  const Vec3 shoulder = target.positions[arm.spec.upper], own = target.positions[arm.spec.end] - shoulder;
  const Vec3 displacement = arm.goal.position - shoulder;
  const double far = std::max(own.norm(), kReaching.softReach * arm.spec.length),
               near = std::min(own.norm(), kReaching.softFold * arm.spec.length);
  const double distance = displacement.norm();
  if (distance > far) {
    arm.goal.position = shoulder + towards(kMaxStretch * arm.spec.length, far, distance) / distance * displacement;
  } else if (distance < near) {
    const Vec3 line = distance > 0 ? displacement.normalized() : own.normalized();
    arm.goal.position = shoulder + towards(kReaching.fold * near, near, distance) * line;
  }
}

void HandGoals::set(const BodyFrame& source, const BodyFrame& target, double seconds) {
  const double reach = setup_.options.reach;
  const Vec3 pelvis = pelvisOf(setup_.map, MapSide::kSource, source.positions), position = setup_.positionOf(pelvis);
  std::array<Vec3, 2> touches = {Vec3::Zero(), Vec3::Zero()};
  for (std::size_t a = 0; a < arms_.size(); ++a) {
    Arm& arm = arms_[a];
    arm.goal.position = target.positions[arm.spec.end];
    if (reach != 0)
      arm.goal.position +=
          reach * (position + setup_.scale * (source.positions[arm.spec.sourceEnd] - pelvis) - arm.goal.position);
    if (setup_.options.contacts) touches[a] = touchOf(arm, surfaces_[a], source, target);
  }
  if (!setup_.options.contacts) return;
  if (arms_.size() == 2) {
    const Vec3 apart =
        (source.positions[arms_[1].spec.sourceEnd] - source.positions[arms_[0].spec.sourceEnd]) / hands_.source;
    const Vec3 change =
        hands_.target * apart - (arms_[1].goal.position + touches[1] - arms_[0].goal.position - touches[0]);
    const double weight = 0.5 * closeness(apart.norm(), kHands);
    touches[0] -= weight * change;
    touches[1] += weight * change;
  }
  for (std::size_t a = 0; a < arms_.size(); ++a) {
    Sprung& follow = follows_[a];
    follow.drawTo(atMost(touches[a], kReaching.maxTouch * arms_[a].spec.length), kArmRate, seconds);
    if (follow.value.norm() < 1e-9 * setup_.targetHipHeight) continue;
    arms_[a].goal.position += follow.value;
    softenReach(arms_[a], target);
  }
}

}  // namespace limber
