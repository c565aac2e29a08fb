#include "limber/motion/limbs/limb_goals.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "limber/core/rotation.h"
#include "limber/motion/limbs/contacts/foot_pitch.h"
#include "limber/motion/limbs/smooth.h"
#include "limber/motion/limbs/spring.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// Hip heights; 0.5 to 1.5; how far a planted foot may be from its joint angles; by jerk on the shared motions (0.25 and
// 0.5 before).
constexpr double kFootSlack = 0.9;
// 1/seconds; 10 to 60; of Leg::changed; by jerk on all 528 shared pairs of a motion and a person.
constexpr double kChangeRate = 25;
constexpr double kRiseRate = 40;  // 1/seconds; 20 to 80; of an animal's pelvis, as feet let go; set by hand

// Hip heights, where nothing else is said. A point that comes down slows within kSoftGround of the ground, and the
// faster it falls within up to kMostSoft more: what it falls in kFallSeconds. By jerk on the shared pairs of a motion
// and a person (at most 1.1 times the source's on 526 of 528).
constexpr double kSoftGround = 0.006;  // 0.002 to 0.01
constexpr double kMaxSoftness = 0.04;  // 0.02 to 0.08
constexpr double kFallSeconds = 0.03;  // seconds; 0.01 to 0.06
constexpr double kFallRate = 40;       // 1/seconds; 20 to 80; by which that speed is smoothed
// Fractions of that softness that a planted foot loses; 0 to 1; the point that is pinned, and the other; by jerk on the
// shared people.
constexpr double kFirmPinned = 0.9, kFirmBeside = 0.2;
// Hip heights of the source; 0.001 to 0.01; where its foot sinks below its resting height; set on a wolf's idle as a
// horse, which trembled before.
constexpr double kSoftLowered = 0.003;
constexpr double kTipLies = 0.05;  // hip heights; 0.02 to 0.1; below it toes of the target alone lie down; set by hand
// Fraction; 0 to 1; of its hip's rise that a person's free foot takes part in; by jerk on all 528 shared pairs (0.7
// before).
constexpr double kCarriedUp = 0.5;

// Of foot-driven legs; set by hand on farm animals' clips on each other, where nothing else is said.
// Leg lengths; 0.01 to 0.06 lifted, 0.001 to 0.01 planted; before a leg is stretched.
constexpr double kSoftLeg = 0.03, kSoftStanding = 0.003;
// Squared cosine of half an angle; 0.25 to 0.75; a body that leans by more faces nowhere (0.5: 90 degrees); set by
// hand.
constexpr double kFaces = 0.5;
// Hip heights a second; 0.3 to 1, 0.2 to 0.8 of people (set on a dinosaur's clips on them); at which planted feet slip
// by half, with an exponent of 2 to 4.
constexpr double kSlipSpeed = 0.65, kPersonSlipSpeed = 0.4, kSlipPower = 3;

// Lengths of the line from hip to ankle; 0.002 to 0.03; a knee of an animal that is further off it tells to which side
// it bends; set by hand.
constexpr double kBentInRest = 0.01;
// Radians that toes point down; pi / 2 to pi, the first below the second; between them a sole comes to look up, and
// toes are no longer levelled. The third: 0.02 to 0.2; over which levelling begins. Set by hand.
constexpr double kSteep = 1.7, kSoleUp = 2.4, kSoftLevel = 0.05;

// How far the lower joint is off the line from the upper one to the end, in lengths of that line.
Vec3 bendAtRest(const LegJoints& leg, const NeutralPose& neutral) {
  const Vec3 upper = neutral.positions[leg.upper], line = neutral.positions[leg.end] - upper;
  const Vec3 lower = neutral.positions[leg.lower] - upper;
  return (lower - lower.dot(line) / line.squaredNorm() * line) / line.norm();
}

WatchedFoot watched(const Leg& leg) {
  return {leg.sourceEnd, leg.toes ? leg.sourceToes : std::nullopt, leg.sourceAnkleGround, leg.sourceToesGround};
}

}  // namespace

LimbGoals::LimbGoals(const RetargetSetup& setup, const RootPositioner& root)
    : setup_(setup), root_(root), pelvis_(setup, root), lift_(setup), tail_(setup, root), contacts_(setup) {
  if (setup.person) {
    addPersonsLegs(root);
  } else {
    addAnimalsLegs(root);
  }
  active_ = (setup.person || !legs_.empty()) && !setup.sameBody;
}

void LimbGoals::addPersonsLegs(const RootPositioner& root) {
  for (const Side side : kSides) {
    const auto limb = findLimb(setup_, root, PartKind::kLeg, side);
    if (!limb) continue;
    Leg leg;
    static_cast<Limb&>(leg) = *limb;
    if (const JointMatch* toes = setup_.map.find(body_part::leg(side, Segment::kToes))) {
      leg.toes = toes->target.front();
      leg.sourceToes = toes->source.front();
    } else {
      leg.tip = toesOf(*setup_.target, setup_.map, MapSide::kTarget, side, setup_.targetNeutral.restPositions);
    }
    const JointMatch &shin = *setup_.map.find(body_part::leg(side, Segment::kMiddle)),
                     &hips = *setup_.map.find(body_part::kPelvis);
    leg.footDriven = isBent(shin.source, leg.sourceEnd, setup_.sourceNeutral.restPositions);
    if (leg.footDriven) leg.sourceBody = hips.source.back();
    addLeg(leg);
    const LegJoints from = {leg.sourceUpper, shin.source.front(), leg.sourceEnd, {}, {}, {}};
    const LegJoints to = {leg.upper, leg.lower, leg.end, {}, {}, {}};
    if (leg.footDriven) states_.back().bend.emplace(setup_, AnimalLeg{from, to});
  }
}

void LimbGoals::addAnimalsLegs(const RootPositioner& root) {
  std::vector<AnimalLeg> hindFirst = setup_.animalLegs;
  std::stable_partition(hindFirst.begin(), hindFirst.end(),
                        [&](const AnimalLeg& leg) { return !pelvis_.trunk().isFore(leg.target.upper); });
  for (const AnimalLeg& found : hindFirst) {
    const auto limb = makeLimb(setup_, root, found.source, found.target);
    if (!limb) continue;
    Leg leg;
    static_cast<Limb&>(leg) = *limb;
    const Vec3 ahead = bendAtRest(found.target, setup_.targetNeutral);
    if (ahead.norm() > kBentInRest) leg.kneeAhead = ahead.normalized();
    leg.hock = found.target.hock;
    leg.fore = pelvis_.trunk().isFore(leg.upper);
    leg.footDriven = root.isFootDriven(found);
    leg.ownBend = leg.footDriven || bendAtRest(found.source, setup_.sourceNeutral).dot(leg.kneeAhead) < kBentInRest;
    if (leg.footDriven) leg.sourceBody = sourceBodyOf(found);
    leg.toes = found.target.toes;
    leg.sourceToes = found.source.toes;
    addLeg(leg);
    if (leg.footDriven) states_.back().bend.emplace(setup_, found);
  }
}

std::optional<Index> LimbGoals::sourceBodyOf(const AnimalLeg& leg) const {
  const Skeleton& source = *setup_.source;
  const auto carriesOther = [&](Index joint) {
    return std::any_of(setup_.animalLegs.begin(), setup_.animalLegs.end(), [&](const AnimalLeg& other) {
      return other.source.upper != leg.source.upper && isAncestorOrSelf(source, joint, other.source.upper);
    });
  };
  std::optional<Index> body = source.joints[leg.source.upper].parent;
  while (body && !carriesOther(*body)) body = source.joints[*body].parent;
  return body;
}

void LimbGoals::addLeg(Leg leg) {
  const auto sourceGround = [&](Index joint) {
    return setup_.sourceGround + setup_.sourceNeutral.positions[joint].y() - setup_.sourceLowest;
  };
  const auto targetGround = [&](Index joint) {
    return setup_.targetGround + setup_.targetNeutral.positions[joint].y() - setup_.targetLowest;
  };
  leg.ankleGround = targetGround(leg.end);
  leg.sourceAnkleGround = sourceGround(leg.sourceEnd);
  if (leg.toes) {
    leg.toesGround = targetGround(*leg.toes);
    leg.sourceToesGround = sourceGround(*leg.sourceToes);
  }
  if (leg.tip) leg.toesGround = targetGround(*leg.tip);
  leg.footPitch = footPitchFraction(setup_, leg);
  legs_.push_back(leg);
  states_.emplace_back();
  contacts_.watch(watched(leg));
}

std::vector<WatchedFoot> LimbGoals::watchedFeet() const {
  std::vector<WatchedFoot> feet;
  for (const Leg& leg : legs_) feet.push_back(watched(leg));
  return feet;
}

// Where the target's foot is by its joint angles, and the ground under it.
void LimbGoals::readFoot(Leg& leg, FootState& state, const BodyFrame& source, const BodyFrame& target,
                         double seconds) const {
  FootLock::Frame& foot = state.foot;
  const FootLock::Frame before = foot;
  foot.anchor = leg.contact.anchor;
  foot.flat = leg.contact.flat;
  leg.position = target.positions[leg.end];
  if (leg.footDriven) leg.position = footDrivenPosition(leg, source, target);
  foot.ankle = foot.toes = leg.position;
  foot.ankleGround = leg.ankleGround - loweredBy(leg.sourceAnkleGround, source.positions[leg.sourceEnd]);
  if (leg.toes) {
    foot.toes += target.positions[*leg.toes] - target.positions[leg.end];
    foot.toesGround = leg.toesGround - loweredBy(leg.sourceToesGround, source.positions[*leg.sourceToes]);
  }
  followFall(before.ankle.y() - foot.ankle.y(), seconds, state.ankleFall);
  followFall(before.toes.y() - foot.toes.y(), seconds, state.toesFall);
  leg.ankleFloor = foot.ankleGround;
  leg.toesFloor = foot.toesGround;
  leg.wanted = true;
  if (leg.footDriven) readFootDriven(leg, state, source, seconds);
}

// Relative to its hip, which a longer or shorter trunk that turns takes further or less far; the leg's offset from the
// hip at rest turns with the body. Its height follows the source's.
Vec3 LimbGoals::footDrivenPosition(const Leg& leg, const BodyFrame& source, const BodyFrame& target) const {
  const std::vector<Vec3>&from = setup_.sourceNeutral.restPositions, &to = setup_.targetNeutral.restPositions;
  const Vec3 atRest = to[leg.end] - to[leg.upper] - setup_.scale * (from[leg.sourceEnd] - from[leg.sourceUpper]);
  const Vec3 displacement = setup_.scale * (source.positions[leg.sourceEnd] - source.positions[leg.sourceUpper]);
  Vec3 position = target.positions[leg.upper] + displacement + turnedAsBody(atRest, leg, source);
  const double restHeight = setup_.person ? leg.ankleGround : to[leg.end].y();
  const double sourceRestHeight = setup_.person ? leg.sourceAnkleGround : from[leg.sourceEnd].y();
  position.y() = restHeight + setup_.scale * (source.positions[leg.sourceEnd].y() - sourceRestHeight);
  return position;
}

// About the vertical, as the source's body is where the leg hangs on it. One that lies on its back faces nowhere.
Vec3 LimbGoals::turnedAsBody(const Vec3& displacement, const Leg& leg, const BodyFrame& source) const {
  const Quat turn = turnOfBody(leg, source);
  const double size = turn.w() * turn.w() + turn.y() * turn.y();
  if (!(size > 0)) return Vec3::Zero();
  return smoothStep(size / kFaces) * (Quat(turn.w(), 0, turn.y(), 0).normalized() * displacement);
}

Quat LimbGoals::turnOfBody(const Leg& leg, const BodyFrame& source) const {
  if (!leg.sourceBody) return Quat::Identity();
  return source.rotations[*leg.sourceBody] * setup_.sourceNeutral.rotations[*leg.sourceBody].conjugate();
}

// The foot rests about as still as the source's: movement there is intended. People who lie down lift their feet.
void LimbGoals::readFootDriven(Leg& leg, FootState& state, const BodyFrame& source, double seconds) const {
  leg.lift = (source.positions[leg.sourceEnd].y() - leg.sourceAnkleGround) / setup_.sourceHipHeight;
  leg.bentReach = state.bend->reach(source);
  const Quat body = turnOfBody(leg, source);
  if (setup_.person) {
    leg.lift += kLifted * smoothStep(1 - (body * Vec3::UnitY()).y());
  } else {
    const double leans = (body * Vec3::UnitX()).y();
    leg.upright = 1 - leans * leans;
  }
  const Vec3 displacement = source.positions[leg.sourceEnd] - state.sourceEnd;
  const double speed =
      seconds > 0 ? std::hypot(displacement.x(), displacement.z()) / (seconds * setup_.sourceHipHeight) : 0;
  state.foot.slip = 1 / (1 + std::pow((setup_.person ? kPersonSlipSpeed : kSlipSpeed) / speed, kSlipPower));
  state.sourceEnd = source.positions[leg.sourceEnd];
}

// `down` is the downward displacement in this frame.
void LimbGoals::followFall(double down, double seconds, Fall& fall) {
  springTo(seconds > 0 ? std::max(down / seconds, 0.0) : 0.0, kFallRate, seconds, fall.speed, fall.change);
}

// Animals that sit lay the whole foot down: as far as a joint in the source is below where it is when standing, it may
// be in the target.
double LimbGoals::loweredBy(double sourceGround, const Vec3& sourcePosition) const {
  const double soft = kSoftLowered * setup_.sourceHipHeight;
  return setup_.person ? 0 : setup_.scale * softPositive(sourceGround - sourcePosition.y(), soft);
}

void LimbGoals::adaptPose(const BodyFrame& source, double seconds, Pose& target, BodyFrame& frame) {
  contacts_.next(source, seconds);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    legs_[i].contact = contacts_.foot(i);
    if (!atCut()) continue;
    states_[i].lock.reset();
    states_[i].carried = Vec3::Zero();
  }
  pelvis_.levelHips(target, frame);
  pelvis_.trunk().follow(source, target, frame);
  if (!setup_.person) root_.movePelvis(Vec3(0, lift_(source, frame), 0), target, frame);
  limitFootPitch(setup_, root_, legs_, target, frame);
}

void LimbGoals::setFeet(const BodyFrame& source, const BodyFrame& target, double seconds) {
  if (atCut()) seconds = 0;
  for (std::size_t i = 0; i < legs_.size(); ++i) readFoot(legs_[i], states_[i], source, target, seconds);
  carryFeet(target, seconds);
  for (std::size_t i = 0; i < legs_.size(); ++i) setFoot(legs_[i], states_[i], states_[i].lock, seconds);
  const Quat turn = pelvis_.turnFor(legs_, target);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    const double change = pelvis_.changeOf(legs_[i], target, turn);
    springTo(change, kChangeRate, seconds, legs_[i].changed, states_[i].changedSpeed);
  }
  rise_ = nextRise(target, seconds);
}

LimbGoals::Rise LimbGoals::nextRise(const BodyFrame& target, double seconds) const {
  Rise rise = rise_;
  const double wanted = pelvis_.riseFor(legs_, target, pelvis_.turnFor(legs_, target));
  const bool atOnce = setup_.person || legs_.front().footDriven;
  springTo(wanted, kRiseRate, atOnce ? 0 : seconds, rise.value, rise.speed);
  return rise;
}

Pelvis::Move LimbGoals::pelvisMove(const BodyFrame& target) const {
  return pelvis_.moveFor(legs_, target, rise_.value);
}

// Where the pelvis follows planted feet, free ones go along with their hips: their legs would else have to make up for
// every move of it. Goals by the frame before tell where it goes in this one.
void LimbGoals::carryFeet(const BodyFrame& target, double seconds) {
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    FootLock trial = states_[i].lock;
    setFoot(legs_[i], states_[i], trial, seconds);
  }
  const Pelvis::Move move = pelvis_.moveFor(legs_, target, nextRise(target, seconds).value);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    states_[i].carried = legs_[i].footDriven ? Vec3(Vec3::Zero()) : pelvis_.hipDisplacement(move, legs_[i], target);
    if (setup_.person) states_[i].carried.y() *= kCarriedUp;
  }
}

void LimbGoals::setFoot(Leg& leg, const FootState& state, FootLock& lock, double seconds) const {
  FootLock::Frame foot = state.foot;
  foot.ankle += state.carried;
  foot.toes += state.carried;
  leg.goal = lock.next(foot, seconds, kFootSlack * setup_.targetHipHeight);
  if (leg.footDriven) leg.goal.y() = foot.ankle.y();
  leg.turn = Eigen::AngleAxisd(lock.twist(), Vec3::UnitY());
  keepAboveGround(leg, foot, state);
}

// Both ends of the foot, without a kink, and the earlier the faster they come down; last the one that holds it.
void LimbGoals::keepAboveGround(Leg& leg, const FootLock::Frame& foot, const FootState& state) const {
  const double toesOver = foot.toes.y() - foot.ankle.y();
  const auto raise = [&](double under, const Fall& fall, double firm) {
    const double height = setup_.targetHipHeight, ahead = kFallSeconds * std::max(fall.speed, 0.0) / height;
    const double soft = kSoftGround + kMaxSoftness * ahead / (kMaxSoftness + ahead);
    leg.goal.y() += softPositive(under, height * soft * (1 - firm * leg.contact.strength));
  };
  const auto raiseAnkle = [&](double firm) { raise(foot.ankleGround - leg.goal.y(), state.ankleFall, firm); };
  const auto raiseToes = [&](double firm) {
    if (leg.toes) raise(foot.toesGround - toesOver - leg.goal.y(), state.toesFall, firm);
  };
  if (leg.contact.anchor == FootAnchor::kToes) {
    raiseAnkle(kFirmBeside);
    raiseToes(kFirmPinned);
  } else {
    raiseToes(kFirmBeside);
    raiseAnkle(kFirmPinned);
  }
}

void LimbGoals::bendAsSource(Leg& leg, const BodyFrame& target) const {
  const Vec3 hip = target.positions[leg.upper], displacement = leg.goal - hip;
  const double own = displacement.norm(), most = kMaxStretch * leg.length;
  if (!leg.footDriven || !(own > 0)) return;
  const double free = smoothStep(leg.lift / kLifted), length = own + free * (leg.bentReach - own);
  const double soft = kSoftStanding + free * (kSoftLeg - kSoftStanding);
  const double reached = most - softPositive(most - length, soft * leg.length);
  const Vec3 change = (reached / own - 1) * displacement;
  const double down = -change.y(), room = heightOverGround(leg, target);
  // The nearer to the ground the slower.
  leg.goal += down > 0 ? Vec3(room / down * (1 - std::exp(-down / room)) * change) : change;
}

// Of a goal, both ends of the foot; more than nothing.
double LimbGoals::heightOverGround(const Leg& leg, const BodyFrame& target) const {
  double ground = leg.ankleFloor;
  if (leg.toes) {
    ground = std::max(ground, leg.toesFloor - (target.positions[*leg.toes] - target.positions[leg.end]).y());
  }
  return std::max(leg.goal.y() - ground, 1e-9 * setup_.targetHipHeight);
}

void LimbGoals::levelToes(const Leg& leg, BodyFrame& frame, Pose& target) const {
  if (leg.tip) keepTipUp(setup_, root_, leg, target, frame);
  const std::optional<Index> toes = leg.toes ? leg.toes : leg.tip;
  if (!setup_.person || !toes) return;
  const Quat turn = frame.rotations[*toes] * setup_.targetNeutral.rotations[*toes].conjugate();
  const double down = std::max(std::atan2(-(turn * Vec3::UnitZ()).y(), (turn * Vec3::UnitY()).y()), 0.0);
  const double over = (frame.positions[*toes].y() - leg.toesGround) / setup_.targetHipHeight;
  const double lies = leg.toes ? leg.contact.strength : smoothStep(1 - over / kTipLies);
  const double fraction = lies * std::clamp((kSoleUp - down) / (kSoleUp - kSteep), 0.0, 1.0);
  const double up = fraction * down * down / (down + kSoftLevel);
  if (up < 1e-9) return;
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat level = Eigen::AngleAxisd(-up, turn * Vec3::UnitX()) * frame.rotations[*toes];
  target.locals[*toes].rotation = (kinematics.parentRotation(*toes, frame).conjugate() * level).normalized();
  kinematics.globals(target, frame);
  root_.settle(target, frame);
}

}  // namespace limber
