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

struct Following {
  // Hip heights; 0.5 to 1.5; how far a planted foot may be from its joint angles; by jerk on the shared motions (0.25
  // and 0.5 before).
  double footSlack = 0.9;
  // 1/seconds; 10 to 60; of LimbState::changed; by jerk on all 528 shared pairs of a motion and a person.
  double changeRate = 25;
  double riseRate = 40;  // 1/seconds; 20 to 80; of an animal's pelvis, as feet let go; set by hand
};
constexpr Following kFollowing;

struct Landing {
  // Hip heights, where nothing else is said. A point that comes down slows within softGround of the ground, and the
  // faster it falls within up to maxSoftness more: what it falls in fallSeconds. By jerk on the shared pairs of a
  // motion and a person (at most 1.1 times the source's on 526 of 528).
  double softGround = 0.006;  // 0.002 to 0.01
  double maxSoftness = 0.04;  // 0.02 to 0.08
  double fallSeconds = 0.03;  // seconds; 0.01 to 0.06
  double fallRate = 40;       // 1/seconds; 20 to 80; by which that speed is smoothed
  // Fractions of that softness that a planted foot loses; 0 to 1; the point that is pinned, and the other; by jerk on
  // the shared people.
  double firmPinned = 0.9, firmBeside = 0.2;
  // Hip heights of the source; 0.001 to 0.01; where its foot sinks below its resting height; set on a wolf's idle as a
  // horse, which trembled before.
  double softLowered = 0.003;
  double tipLies = 0.05;  // hip heights; 0.02 to 0.1; below it toes of the target alone lie down; set by hand
};
constexpr Landing kLanding;
struct Driving {
  // Of foot-driven legs; set by hand on farm animals' clips on each other, where nothing else is said.
  // Leg lengths; 0.01 to 0.06 lifted, 0.001 to 0.01 planted; before a leg is stretched.
  double softLeg = 0.03, softStanding = 0.003;
  // Squared cosine of half an angle; 0.25 to 0.75; a body that leans by more faces nowhere (0.5: 90 degrees); set by
  // hand.
  double faces = 0.5;
  double slipPower = 3;  // exponent; 2 to 4; of FootDrive::slipSpeed
};
constexpr Driving kDriving;

struct Levelling {
  // Radians that toes point down; pi / 2 to pi, the first below the second; between them a sole comes to look up, and
  // toes are no longer levelled. The third: 0.02 to 0.2; over which levelling begins. Set by hand.
  double steep = 1.7, soleUp = 2.4, softLevel = 0.05;
};
constexpr Levelling kLevelling;

WatchedFoot watched(const LegSpec& leg) {
  return {leg.sourceEnd, leg.toes ? leg.sourceToes : std::nullopt, leg.sourceAnkleGround, leg.sourceToesGround};
}

}  // namespace

LimbGoals::LimbGoals(const RetargetSetup& setup, const RootPositioner& root)
    : setup_(setup), root_(root), pelvis_(setup, root), lift_(setup), tail_(setup, root), contacts_(setup) {
  for (const LegSpec& leg : findLegs(setup, root, pelvis_.trunk())) {
    legs_.push_back({leg, {}, {}});
    contacts_.watch(watched(leg));
  }
  states_.resize(legs_.size());
  active_ = (setup.person || !legs_.empty()) && !setup.sameBody;
}

std::vector<LegSpec> LimbGoals::specs() const {
  std::vector<LegSpec> specs;
  for (const Leg& leg : legs_) specs.push_back(leg.spec);
  return specs;
}

bool LimbGoals::feetAreDriven() const {
  return std::any_of(legs_.begin(), legs_.end(), [](const Leg& leg) { return leg.spec.drive.has_value(); });
}

std::vector<WatchedFoot> LimbGoals::watchedFeet() const {
  std::vector<WatchedFoot> feet;
  for (const Leg& leg : legs_) feet.push_back(watched(leg.spec));
  return feet;
}

// Where the target's foot is by its joint angles, and the ground under it.
void LimbGoals::readFoot(Leg& leg, FootState& state, const BodyFrame& source, const BodyFrame& target,
                         double seconds) const {
  const LegSpec& spec = leg.spec;
  FootLock::Frame& foot = state.foot;
  const FootLock::Frame before = foot;
  foot.anchor = leg.state.contact.anchor;
  foot.flat = leg.state.contact.flat;
  leg.state.position = target.positions[spec.end];
  if (spec.drive) driveFoot(leg, state, source, target, seconds);
  foot.ankle = foot.toes = leg.state.position;
  foot.ankleGround = spec.ankleGround - loweredBy(spec, spec.sourceAnkleGround, source.positions[spec.sourceEnd]);
  if (spec.toes) {
    foot.toes += target.positions[*spec.toes] - target.positions[spec.end];
    foot.toesGround = spec.toesGround - loweredBy(spec, spec.sourceToesGround, source.positions[*spec.sourceToes]);
  }
  const auto follow = [&](double down, SprungNumber& fall) {
    fall.drawTo(seconds > 0 ? std::max(down / seconds, 0.0) : 0.0, kLanding.fallRate, seconds);
  };
  follow(before.ankle.y() - foot.ankle.y(), state.ankleFall);
  follow(before.toes.y() - foot.toes.y(), state.toesFall);
  leg.state.ankleFloor = foot.ankleGround;
  leg.state.toesFloor = foot.toesGround;
}

// Relative to its hip, which a longer or shorter trunk that turns takes further or less far; the leg's offset from the
// hip at rest turns with the body. Its height follows the source's.
Vec3 LimbGoals::drivenPosition(const LegSpec& leg, const BodyFrame& source, const BodyFrame& target) const {
  const std::vector<Vec3>&from = setup_.sourceNeutral.restPositions, &to = setup_.targetNeutral.restPositions;
  const Vec3 atRest = to[leg.end] - to[leg.upper] - setup_.scale * (from[leg.sourceEnd] - from[leg.sourceUpper]);
  const Vec3 displacement = setup_.scale * (source.positions[leg.sourceEnd] - source.positions[leg.sourceUpper]);
  Vec3 position = target.positions[leg.upper] + displacement + turnedAsBody(atRest, *leg.drive, source);
  position.y() =
      leg.drive->restHeight + setup_.scale * (source.positions[leg.sourceEnd].y() - leg.drive->sourceRestHeight);
  return position;
}

// About the vertical, as the source's body is where the leg is attached to it. One that lies on its back faces nowhere.
Vec3 LimbGoals::turnedAsBody(const Vec3& displacement, const FootDrive& drive, const BodyFrame& source) const {
  const Quat turn = turnOfBody(drive, source);
  const double size = turn.w() * turn.w() + turn.y() * turn.y();
  if (!(size > 0)) return Vec3::Zero();
  return smoothStep(size / kDriving.faces) * (Quat(turn.w(), 0, turn.y(), 0).normalized() * displacement);
}

Quat LimbGoals::turnOfBody(const FootDrive& drive, const BodyFrame& source) const {
  if (!drive.sourceBody) return Quat::Identity();
  return source.rotations[*drive.sourceBody] * setup_.sourceNeutral.rotations[*drive.sourceBody].conjugate();
}

// The foot rests about as still as the source's: movement there is intended. People who lie down lift their feet.
void LimbGoals::driveFoot(Leg& leg, FootState& state, const BodyFrame& source, const BodyFrame& target,
                          double seconds) const {
  const FootDrive& drive = *leg.spec.drive;
  const Vec3& sourceEnd = source.positions[leg.spec.sourceEnd];
  leg.state.position = drivenPosition(leg.spec, source, target);
  leg.state.lift = (sourceEnd.y() - leg.spec.sourceAnkleGround) / setup_.sourceHipHeight;
  leg.state.bentReach = drive.bend.reach(source);
  const Quat body = turnOfBody(drive, source);
  if (drive.uprightBody) {
    leg.state.lift += kLifted * smoothStep(1 - (body * Vec3::UnitY()).y());
  } else {
    const double leans = (body * Vec3::UnitX()).y();
    leg.state.upright = 1 - leans * leans;
  }
  const Vec3 displacement = sourceEnd - state.sourceEnd;
  const double speed =
      seconds > 0 ? std::hypot(displacement.x(), displacement.z()) / (seconds * setup_.sourceHipHeight) : 0;
  state.foot.slip = 1 / (1 + std::pow(drive.slipSpeed / speed, kDriving.slipPower));
  state.sourceEnd = sourceEnd;
}

// Of what rests on its toes: sitting animals lay the whole foot down. As far as a joint in the source is below where it
// is when standing, it may be in the target.
double LimbGoals::loweredBy(const LegSpec& leg, double sourceGround, const Vec3& sourcePosition) const {
  const double soft = kLanding.softLowered * setup_.sourceHipHeight;
  return leg.plantigrade ? 0 : setup_.scale * softPositive(sourceGround - sourcePosition.y(), soft);
}

void LimbGoals::adaptPose(const BodyFrame& source, double seconds, Pose& target, BodyFrame& frame) {
  contacts_.next(source, seconds);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    legs_[i].state.contact = contacts_.foot(i);
    if (!atCut()) continue;
    states_[i].lock.reset();
    states_[i].carried = Vec3::Zero();
  }
  pelvis_.levelHips(target, frame);
  pelvis_.trunk().follow(source, target, frame);
  lift_.apply(source, root_, target, frame);
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
    springTo(change, kFollowing.changeRate, seconds, legs_[i].state.changed, states_[i].changedSpeed);
  }
  rise_ = nextRise(target, seconds);
}

SprungNumber LimbGoals::nextRise(const BodyFrame& target, double seconds) const {
  SprungNumber rise = rise_;
  const double goal = pelvis_.riseFor(legs_, target, pelvis_.turnFor(legs_, target));
  const bool atOnce = legs_.empty() || legs_.front().spec.support.risesAtOnce;
  rise.drawTo(goal, kFollowing.riseRate, atOnce ? 0 : seconds);
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
    const Vec3 displacement = pelvis_.hipDisplacement(move, legs_[i].spec, target);
    states_[i].carried = legs_[i].spec.support.carried.cwiseProduct(displacement);
  }
}

void LimbGoals::setFoot(Leg& leg, const FootState& state, FootLock& lock, double seconds) const {
  FootLock::Frame foot = state.foot;
  foot.ankle += state.carried;
  foot.toes += state.carried;
  leg.goal.position = lock.next(foot, seconds, kFollowing.footSlack * setup_.targetHipHeight);
  if (leg.spec.drive) leg.goal.position.y() = foot.ankle.y();
  leg.goal.turn = Eigen::AngleAxisd(lock.twist(), Vec3::UnitY());
  keepAboveGround(leg, foot, state);
}

// Both ends of the foot, without a kink, and the earlier the faster they come down; last the one that holds it.
void LimbGoals::keepAboveGround(Leg& leg, const FootLock::Frame& foot, const FootState& state) const {
  const double toesOver = foot.toes.y() - foot.ankle.y();
  const auto raise = [&](double under, const SprungNumber& fall, double firm) {
    const double height = setup_.targetHipHeight, ahead = kLanding.fallSeconds * std::max(fall.value, 0.0) / height;
    const double soft = kLanding.softGround + kLanding.maxSoftness * ahead / (kLanding.maxSoftness + ahead);
    leg.goal.position.y() += softPositive(under, height * soft * (1 - firm * leg.state.contact.strength));
  };
  const auto raiseAnkle = [&](double firm) { raise(foot.ankleGround - leg.goal.position.y(), state.ankleFall, firm); };
  const auto raiseToes = [&](double firm) {
    if (leg.spec.toes) raise(foot.toesGround - toesOver - leg.goal.position.y(), state.toesFall, firm);
  };
  if (leg.state.contact.anchor == FootAnchor::kToes) {
    raiseAnkle(kLanding.firmBeside);
    raiseToes(kLanding.firmPinned);
  } else {
    raiseToes(kLanding.firmBeside);
    raiseAnkle(kLanding.firmPinned);
  }
}

void LimbGoals::bendAsSource(Leg& leg, const BodyFrame& target) const {
  const Vec3 hip = target.positions[leg.spec.upper], displacement = leg.goal.position - hip;
  const double own = displacement.norm(), most = kMaxStretch * leg.spec.length;
  if (!leg.spec.drive || !(own > 0)) return;
  const double free = smoothStep(leg.state.lift / kLifted), length = own + free * (leg.state.bentReach - own);
  const double soft = kDriving.softStanding + free * (kDriving.softLeg - kDriving.softStanding);
  const double reached = most - softPositive(most - length, soft * leg.spec.length);
  const Vec3 change = (reached / own - 1) * displacement;
  const double down = -change.y(), room = heightOverGround(leg, target);
  // The nearer to the ground the slower.
  leg.goal.position += down > 0 ? Vec3(room / down * (1 - std::exp(-down / room)) * change) : change;
}

// Of a goal, both ends of the foot; more than nothing.
double LimbGoals::heightOverGround(const Leg& leg, const BodyFrame& target) const {
  double ground = leg.state.ankleFloor;
  if (leg.spec.toes) {
    ground =
        std::max(ground, leg.state.toesFloor - (target.positions[*leg.spec.toes] - target.positions[leg.spec.end]).y());
  }
  return std::max(leg.goal.position.y() - ground, 1e-9 * setup_.targetHipHeight);
}

void LimbGoals::levelToes(const Leg& leg, BodyFrame& frame, Pose& target) const {
  const LegSpec& spec = leg.spec;
  if (spec.tip) keepTipUp(setup_, root_, spec, target, frame);
  const std::optional<Index> toes = spec.toes ? spec.toes : spec.tip;
  if (!spec.plantigrade || !toes) return;
  const Quat turn = frame.rotations[*toes] * setup_.targetNeutral.rotations[*toes].conjugate();
  const double down = std::max(std::atan2(-(turn * Vec3::UnitZ()).y(), (turn * Vec3::UnitY()).y()), 0.0);
  const double over = (frame.positions[*toes].y() - spec.toesGround) / setup_.targetHipHeight;
  const double lies = spec.toes ? leg.state.contact.strength : smoothStep(1 - over / kLanding.tipLies);
  const double fraction =
      lies * std::clamp((kLevelling.soleUp - down) / (kLevelling.soleUp - kLevelling.steep), 0.0, 1.0);
  const double up = fraction * down * down / (down + kLevelling.softLevel);
  if (up < 1e-9) return;
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat level = Eigen::AngleAxisd(-up, turn * Vec3::UnitX()) * frame.rotations[*toes];
  target.locals[*toes].rotation = (kinematics.parentRotation(*toes, frame).conjugate() * level).normalized();
  kinematics.globals(target, frame);
  root_.settle(target, frame);
}

}  // namespace limber
