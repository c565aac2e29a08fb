#include "limber/motion/retarget/spacetime.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "limber/core/rotation.h"
#include "limber/motion/limbs/body/arm_clearance.h"
#include "limber/motion/limbs/hand_goals.h"
#include "limber/motion/limbs/limb_reach.h"
#include "limber/motion/retarget/displacement_curve.h"
#include "limber/motion/retarget/foot_planting.h"

namespace limber {

namespace {

struct ChangeTimes {
  // Seconds; 0.05 to 0.2; in which changes come and go: of foot-driven legs, of which little is left to change, and of
  // hands (0.1 before). By the judge on half of the shared motions.
  double footDrivenSeconds = 0.13, handSeconds = 0.12;
  double footDrivenRest = 0.1;  // fraction; 0 to 1; how firmly a foot-driven foot keeps its height; likewise
};
constexpr ChangeTimes kChangeTimes;

using Goals = std::vector<CurveGoal>;
using Goals3 = std::array<Goals, 3>;

// Three displacement curves, one for each axis.
struct Curve3 {
  std::array<std::vector<double>, 3> axes;

  Curve3(const Goals3& goals, double frameSeconds, const CurveOptions& options) {
    for (std::size_t axis = 0; axis < 3; ++axis) axes[axis] = displacementCurve(goals[axis], frameSeconds, options);
  }
  Vec3 at(std::size_t f) const { return {axes[0][f], axes[1][f], axes[2][f]}; }
};

// What follows `value` smoothly.
CurveOptions following(double seconds) {
  CurveOptions options;
  options.seconds = seconds;
  options.pull = 0;
  return options;
}

void follow(const Vec3& value, std::size_t frame, Goals3& goals) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    goals[axis][frame].value = value[static_cast<Eigen::Index>(axis)];
    goals[axis][frame].valueWeight = 1;
  }
}

// A foot in one frame before it is planted.
struct FreeFoot {
  Vec3 ankle = Vec3::Zero(), roll = Vec3::Zero();  // and the displacement from there to the toes
  double ankleFloor = 0, toesFloor = 0;
};

class Spacetime {
 public:
  Spacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup),
        root_(setup),
        goals_(setup, root_),
        hands_(setup, root_),
        reach_(setup, root_),
        clearance_(setup, root_),
        source_(source),
        target_(target) {}

  void run() {
    if (!goals_.active() || target_.poses.empty()) return;
    contacts_.emplace(setup_, goals_.watchedFeet(), source_);
    for (std::size_t f = 0; f < frames(); ++f) cuts_.push_back(contacts_->isCut(f));
    if (setup_.options.contacts) {
      gatherFeet();
      twistFeet();
      plantLegs();
      layToes();
    }
    placeHands();
  }

 private:
  std::size_t frames() const { return target_.poses.size(); }
  const BodyFrame& sourceAt(std::size_t f) {
    setup_.sourceKinematics.globals(source_.poses[f], from_);
    return from_;
  }
  BodyFrame& targetAt(std::size_t f) {
    setup_.targetKinematics.globals(target_.poses[f], to_);
    return to_;
  }
  Goals noGoals() const {
    Goals goals(frames());
    for (std::size_t f = 0; f < frames(); ++f) goals[f].cut = cuts_[f];
    return goals;
  }

  void gatherFeet() {
    std::vector<Leg>& legs = goals_.legs();
    feet_.resize(legs.size());
    for (std::size_t f = 0; f < frames(); ++f) {
      const BodyFrame& from = sourceAt(f);
      BodyFrame& to = targetAt(f);
      const double seconds = f == 0 ? 0 : target_.frameSeconds;
      goals_.adaptPose(from, seconds, target_.poses[f], to);
      goals_.setFeet(from, to, seconds);
      // What turns wide hips take over of the source's, planted feet would have to make up for.
      root_.turnPelvis(goals_.pelvis().turnFor(legs, to), target_.poses[f], to);
      driveByFeet(f, to);
      for (std::size_t i = 0; i < feet_.size(); ++i) {
        const Leg& leg = legs[i];
        FreeFoot& foot = feet_[i].emplace_back();
        foot.ankle = to.positions[leg.spec.end];
        foot.ankleFloor = leg.state.ankleFloor;
        foot.toesFloor = -std::numeric_limits<double>::infinity();
        if (!leg.spec.toes) continue;
        foot.roll = to.positions[*leg.spec.toes] - to.positions[leg.spec.end];
        foot.toesFloor = leg.state.toesFloor;
      }
    }
  }

  // Foot-driven legs begin where their feet are driven, with the pelvis over them, not by joint angles.
  void driveByFeet(std::size_t f, BodyFrame& to) {
    std::vector<Leg>& legs = goals_.legs();
    if (!goals_.feetAreDriven()) return;
    goals_.pelvis().apply(goals_.pelvis().moveFor(legs, to), target_.poses[f], to);
    for (Leg& leg : legs) {
      if (!leg.spec.drive) continue;
      goals_.bendAsSource(leg, to);
      leg.goal.turn = Quat::Identity();
      reach_.reach(leg.spec, leg.goal, to, target_.poses[f]);
    }
  }

  // A foot that is planted flat does not turn about the vertical.
  void twistFeet() {
    twists_.assign(frames(), std::vector<double>(feet_.size(), 0.0));
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      const std::vector<FreeFoot>& foot = feet_[i];
      Goals twist = noGoals();
      for (std::size_t f = 1; f < frames(); ++f) {
        if (!contacts_->at(f, i).flat || !contacts_->at(f - 1, i).flat) continue;
        const Vec3 from = alongGround(foot[f - 1].roll), to = alongGround(foot[f].roll);
        twist[f].step = -std::atan2(from.cross(to).y(), from.dot(to));
        twist[f].stepWeight = planting::kTwistHold * contacts_->firmness(f, i);
      }
      const std::vector<double> turns = displacementCurve(twist, target_.frameSeconds, {planting::kTwistSeconds});
      for (std::size_t f = 0; f < frames(); ++f) twists_[f][i] = turns[f];
    }
  }

  Vec3 rollOf(std::size_t i, std::size_t f) const {
    return Eigen::AngleAxisd(twists_[f][i], Vec3::UnitY()) * feet_[i][f].roll;
  }

  // The constraints of the foot: on steps, not on positions. The least squares find where it is planted best.
  FootFrame askedOf(std::size_t i, std::size_t f, const BodyFrame& to) {
    const double unit = 1 / setup_.targetHipHeight;
    const LegSpec& leg = goals_.legs()[i].spec;
    const FreeFoot& now = feet_[i][f];
    const FootAnchor anchor = contacts_->at(f, i).anchor;
    const Vec3 roll = rollOf(i, f);
    const bool byToes = anchor == FootAnchor::kToes;
    const double toesUp = now.toesFloor - roll.y() - now.ankle.y(), ankleUp = now.ankleFloor - now.ankle.y();
    FootFrame asked;
    asked.lowest = unit * std::max(ankleUp, toesUp);
    asked.height = std::max(unit * (byToes ? toesUp : ankleUp), asked.lowest);
    asked.rest = contacts_->firmness(f, i);
    if (leg.drive) {  // its height is its own
      asked.height = std::max(0.0, asked.lowest);
      asked.rest = kChangeTimes.footDrivenRest;
    }
    asked.displacement = unit * (now.ankle - to.positions[leg.upper]);
    asked.most = unit * planting::kStretched * leg.length;
    if (anchor == FootAnchor::kNone) asked.most = std::max(asked.most, asked.displacement.norm());
    if (leg.fore) asked.lift = TrunkTilt::liftOf(trunk().trunkOf(to));
    if (f == 0 || anchor == FootAnchor::kNone || contacts_->at(f - 1, i).anchor == FootAnchor::kNone) return asked;
    asked.hold = contacts_->firmness(f, i);
    asked.step = unit * (feet_[i][f - 1].ankle - now.ankle);
    if (byToes) asked.step += unit * (rollOf(i, f - 1) - roll);
    return asked;
  }

  const TrunkTilt& trunk() const { return goals_.pelvis().trunk(); }

  void plantLegs() {
    if (feet_.empty()) return;
    MovedLegs legs(setup_, root_, trunk(), goals_.specs());
    legs.solveAll(true);
    FootPlanting planting;
    planting.end = frames();
    planting.frameSeconds = target_.frameSeconds;
    if (goals_.feetAreDriven()) planting.changeSeconds = kChangeTimes.footDrivenSeconds;
    planting.cuts = cuts_;
    planting.frameAt = [&](std::size_t f) -> const BodyFrame& { return targetAt(f); };
    planting.askedOf = [&](std::size_t f, std::size_t leg, const BodyFrame& to) { return askedOf(leg, f, to); };
    planting.change = [&](MovedLegs& moved, const ChangeLayout& layout, const Changes& changes, std::size_t index,
                          std::size_t f) { moved.pose(layout, changes, index, target_.poses[f], twists_[f]); };
    plantFeet(legs, planting);
  }

  void layToes() {
    for (std::size_t f = 0; f < frames(); ++f) {
      BodyFrame& to = targetAt(f);
      for (std::size_t i = 0; i < feet_.size(); ++i) {
        Leg& leg = goals_.legs()[i];
        leg.state.contact = contacts_->at(f, i);
        goals_.levelToes(leg, to, target_.poses[f]);
      }
      goals_.tail().apply(target_.poses[f], to);
    }
  }

  void placeHands() {
    std::vector<Arm>& arms = hands_.arms();
    std::vector<Goals3> displacements(arms.size(), {noGoals(), noGoals(), noGoals()});
    for (std::size_t f = 0; f < frames(); ++f) {
      const BodyFrame& to = targetAt(f);
      hands_.set(sourceAt(f), to, 0);  // at once: the curve smooths
      for (std::size_t a = 0; a < arms.size(); ++a) {
        follow(arms[a].goal.position - to.positions[arms[a].spec.end], f, displacements[a]);
      }
    }
    for (std::size_t a = 0; a < arms.size(); ++a) {
      const Curve3 smooth(displacements[a], target_.frameSeconds, following(kChangeTimes.handSeconds));
      for (std::size_t f = 0; f < frames(); ++f) {
        BodyFrame& to = targetAt(f);
        arms[a].goal.position = to.positions[arms[a].spec.end] + smooth.at(f);
        if (LimbReach::isThere(arms[a].spec, arms[a].goal, to)) continue;
        hands_.softenReach(arms[a], to);
        reach_.reach(arms[a].spec, arms[a].goal, to, target_.poses[f]);
      }
    }
    if (setup_.options.contacts) keepArmsOut();
  }

  void keepArmsOut() {
    for (const ArmClearance::Bone bone : {ArmClearance::Bone::kUpper, ArmClearance::Bone::kForearm}) {
      for (std::size_t a = 0; a < clearance_.arms(); ++a) {
        Goals3 displacements = {noGoals(), noGoals(), noGoals()};
        for (std::size_t f = 0; f < frames(); ++f)
          follow(clearance_.displacementOut(a, bone, targetAt(f)), f, displacements);
        const Curve3 smooth(displacements, target_.frameSeconds, following(kChangeTimes.handSeconds));
        for (std::size_t f = 0; f < frames(); ++f) {
          clearance_.swing(a, bone, smooth.at(f), targetAt(f), target_.poses[f]);
        }
      }
    }
  }

  const RetargetSetup& setup_;
  RootPositioner root_;
  LimbGoals goals_;
  HandGoals hands_;
  LimbReach reach_;
  ArmClearance clearance_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::optional<ContactTrack> contacts_;
  std::vector<bool> cuts_;
  std::vector<std::vector<FreeFoot>> feet_;  // of each leg, by frame
  std::vector<std::vector<double>> twists_;  // of each frame, of each leg's foot: radians about +Y
  BodyFrame from_, to_;
};

}  // namespace

void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  Spacetime(setup, source, target).run();
}

}  // namespace limber
