#include "limber/retarget/spacetime.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "limber/ik/rotation.h"
#include "limber/limbs/hand_goals.h"
#include "limber/limbs/limb_reach.h"
#include "limber/retarget/displacement_curve.h"

namespace limber {

namespace {

// In which changes come and go, seconds. Feet: longer, and one that stops a foot would swing it far before and after.
constexpr double kFootSeconds = 0.05, kHandSeconds = 0.12, kPlantSeconds = 0.12;
constexpr double kFootDrivenSeconds = 0.13;  // of two feet that go the source's way: little is left to change
// Weights of a planted foot's steps and height, and of what a foot is below the ground.
constexpr double kStandWeight = 1e8, kGroundWeight = 3e3, kFloorWeight = 1e8;
constexpr std::array<std::size_t, 2> kAlongGround = {0, 2};  // axes

Vec3 level(const Vec3& v) {
  return {v.x(), 0, v.z()};
}

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

// A foot in one frame, as joint angles have it.
struct FootFrame {
  Vec3 ankle = Vec3::Zero(), roll = Vec3::Zero();  // and the way from there to the toes
  FootAnchor anchor = FootAnchor::kNone;
  bool flat = false;
  double ankleFloor = 0, toesFloor = 0;
  bool footDriven = false;  // likewise in Leg, with what follows
  double bentReach = 0, lift = 0, upright = 1;
};

class Spacetime {
 public:
  Spacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup),
        root_(setup),
        goals_(setup, root_),
        hands_(setup, root_),
        reach_(setup, root_),
        source_(source),
        target_(target) {}

  void run() {
    if (!goals_.active() || target_.poses.empty()) return;
    cuts_.assign(frames(), false);
    if (setup_.options.contacts) {
      gatherFeet();
      planFeet();
      movePelvis();
      // Free feet go along with their hips: their legs would else make up for every move of the pelvis.
      moveFeetWithHips();
      planFeet();
      movePelvis();
      placeFeet();
    }
    placeHands();
  }

 private:
  // How one foot is changed.
  struct FootPlan {
    std::vector<double> twist;  // radians about +Y
    Curve3 way;                 // of the ankle
    std::vector<double> planted;
  };

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
  std::vector<double> curve(const Goals& goals, const CurveOptions& options) const {
    return displacementCurve(goals, target_.frameSeconds, options);
  }

  void gatherFeet() {
    contacts_.emplace(setup_, goals_.watchedFeet(), source_);
    feet_.resize(goals_.legs().size());
    for (std::size_t f = 0; f < frames(); ++f) {
      const BodyFrame& from = sourceAt(f);
      BodyFrame& to = targetAt(f);
      const double seconds = f == 0 ? 0 : target_.frameSeconds;
      goals_.adaptPose(from, seconds, target_.poses[f], to);
      goals_.setFeet(from, to, seconds);
      cuts_[f] = goals_.atCut();
      for (std::size_t i = 0; i < feet_.size(); ++i) {
        const Leg& leg = goals_.legs()[i];
        FootFrame& foot = feet_[i].emplace_back();
        foot.ankle = leg.place;
        foot.anchor = leg.contact.anchor;
        foot.flat = leg.contact.flat;
        foot.ankleFloor = leg.ankleFloor;
        foot.footDriven = leg.footDriven;
        foot.bentReach = leg.bentReach;
        foot.lift = leg.lift;
        foot.upright = leg.upright;
        foot.toesFloor = -std::numeric_limits<double>::infinity();
        if (!leg.toes) continue;
        foot.roll = to.positions[*leg.toes] - to.positions[leg.end];
        foot.toesFloor = leg.toesFloor;
      }
    }
  }

  void planFeet() {
    plans_.clear();
    for (std::size_t i = 0; i < feet_.size(); ++i) planFoot(i);
  }

  // Of steps, not of places: where a foot stands best is left to the curve.
  void planFoot(std::size_t i) {
    const std::vector<FootFrame>& foot = feet_[i];
    std::vector<double> firm(frames());
    Goals twist = noGoals(), planted = noGoals();
    for (std::size_t f = 0; f < frames(); ++f) {
      firm[f] = contacts_->firmness(f, i);
      planted[f].value = foot[f].anchor != FootAnchor::kNone ? 1 : 0;
      planted[f].valueWeight = 1;
      if (f == 0 || !foot[f].flat || !foot[f - 1].flat) continue;
      const Vec3 from = level(foot[f - 1].roll), to = level(foot[f].roll);
      twist[f].step = -std::atan2(from.cross(to).y(), from.dot(to));
      twist[f].stepWeight = kStandWeight * firm[f];
    }
    const std::vector<double> twists = curve(twist, {kFootSeconds});
    const bool footDriven = feet_.size() == 2 && foot.front().footDriven;
    const Goals3 way = wayGoals(foot, firm, twists);
    plans_.push_back(
        {twists, Curve3(way, target_.frameSeconds, {footDriven ? kFootDrivenSeconds : kFootSeconds, 1, kFloorWeight}),
         curve(planted, following(kPlantSeconds))});
  }

  Goals3 wayGoals(const std::vector<FootFrame>& foot, const std::vector<double>& firm,
                  const std::vector<double>& twists) const {
    Goals3 way = {noGoals(), noGoals(), noGoals()};
    Vec3 rollBefore = Vec3::Zero();
    for (std::size_t f = 0; f < frames(); ++f) {
      const FootFrame& now = foot[f];
      const Vec3 roll = Eigen::AngleAxisd(twists[f], Vec3::UnitY()) * now.roll;
      const bool byToes = now.anchor == FootAnchor::kToes;
      const double toesUp = now.toesFloor - roll.y() - now.ankle.y(), ankleUp = now.ankleFloor - now.ankle.y();
      CurveGoal& upright = way[1][f];
      upright.least = std::max(ankleUp, toesUp);
      upright.value = std::max(byToes ? toesUp : ankleUp, upright.least);
      if (!now.footDriven) upright.valueWeight = kGroundWeight * firm[f];
      if (f > 0 && now.anchor != FootAnchor::kNone && foot[f - 1].anchor != FootAnchor::kNone) {
        Vec3 step = now.ankle - foot[f - 1].ankle;
        if (byToes) step += roll - rollBefore;
        for (const std::size_t axis : kAlongGround) {
          way[axis][f].step = -step[static_cast<Eigen::Index>(axis)];
          way[axis][f].stepWeight = kStandWeight * firm[f];
        }
      }
      rollBefore = roll;
    }
    return way;
  }

  void setLegs(std::size_t f) {
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      Leg& leg = goals_.legs()[i];
      leg.goal = feet_[i][f].ankle + plans_[i].way.at(f);
      leg.bentReach = feet_[i][f].bentReach;
      leg.lift = feet_[i][f].lift;
      leg.upright = feet_[i][f].upright;
      leg.turn = Eigen::AngleAxisd(plans_[i].twist[f], Vec3::UnitY());
      leg.contact.strength = std::clamp(plans_[i].planted[f], 0.0, 1.0);
    }
  }

  // In every frame at once, as a body does that trembles while its feet stand: a smoothed way would leave the trembling
  // to the legs (jerk up to 1.46 times the source's instead of 1.13, on toys whose legs are short).
  void movePelvis() {
    const Pelvis& pelvis = goals_.pelvis();
    for (std::size_t f = 0; f < frames(); ++f) {
      setLegs(f);
      BodyFrame& to = targetAt(f);
      const Quat turn = pelvis.turnFor(goals_.legs(), to);
      for (Leg& leg : goals_.legs()) leg.changed = pelvis.changeOf(leg, to, turn);
      pelvis.apply(pelvis.moveFor(goals_.legs(), to), target_.poses[f], to);
    }
  }

  void moveFeetWithHips() {
    for (std::size_t f = 0; f < frames(); ++f) {
      const BodyFrame& to = targetAt(f);
      for (std::size_t i = 0; i < feet_.size(); ++i) {
        const Leg& leg = goals_.legs()[i];
        if (!leg.footDriven) feet_[i][f].ankle = to.positions[leg.end];
      }
    }
  }

  void placeFeet() {
    for (std::size_t f = 0; f < frames(); ++f) {
      BodyFrame& to = targetAt(f);
      setLegs(f);
      for (Leg& leg : goals_.legs()) {
        goals_.bendAsSource(leg, to);
        if (!LimbReach::isThere(leg, to)) reach_.reach(leg, &leg.kneeAhead, to, target_.poses[f]);
        goals_.levelToes(leg, to, target_.poses[f]);
      }
      goals_.tail().apply(target_.poses[f], to);
    }
  }

  void placeHands() {
    std::vector<Limb>& arms = hands_.arms();
    std::vector<Goals3> ways(arms.size(), {noGoals(), noGoals(), noGoals()});
    for (std::size_t f = 0; f < frames(); ++f) {
      const BodyFrame& to = targetAt(f);
      hands_.set(sourceAt(f), to, 0);  // at once: the curve smooths
      for (std::size_t a = 0; a < arms.size(); ++a) {
        follow(arms[a].wanted ? Vec3(arms[a].goal - to.positions[arms[a].end]) : Vec3(Vec3::Zero()), f, ways[a]);
      }
    }
    for (std::size_t a = 0; a < arms.size(); ++a) {
      const Curve3 smooth(ways[a], target_.frameSeconds, following(kHandSeconds));
      for (std::size_t f = 0; f < frames(); ++f) {
        BodyFrame& to = targetAt(f);
        arms[a].goal = to.positions[arms[a].end] + smooth.at(f);
        if (LimbReach::isThere(arms[a], to)) continue;
        hands_.softenReach(arms[a], to);
        reach_.reach(arms[a], nullptr, to, target_.poses[f]);
      }
    }
  }

  const RetargetSetup& setup_;
  RootPlacer root_;
  LimbGoals goals_;
  HandGoals hands_;
  LimbReach reach_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::optional<ContactTrack> contacts_;
  std::vector<bool> cuts_;
  std::vector<std::vector<FootFrame>> feet_;  // of each leg, by frame
  std::vector<FootPlan> plans_;
  BodyFrame from_, to_;
};

}  // namespace

void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  Spacetime(setup, source, target).run();
}

}  // namespace limber
