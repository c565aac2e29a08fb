#include "limber/retarget/limb_ik.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "limber/ik/ik_solver.h"
#include "limber/ik/rotation.h"
#include "limber/ik/two_bone.h"
#include "limber/retarget/aligned.h"
#include "limber/retarget/foot_lock.h"
#include "limber/retarget/plant_detector.h"
#include "limber/skeleton/chain.h"

namespace limber {

namespace {

// In hip heights of the target.
constexpr double kTouching = 0.12, kApart = 0.35;  // distances at which hands' contacts begin to count, and do not
constexpr double kMostSinking = 0.12;
constexpr double kFootSlack = 0.25;  // how far a planted foot may be from where the joint angles have it
constexpr double kStretch = 0.9995;  // of a leg's length: fully stretched knees pop
constexpr double kSinkRate = 12;     // 1/seconds, back up
// Speeds of the source's pelvis or feet, hip heights a second, that are no motion but a cut. Many recordings have a
// T-pose as their first frame.
constexpr double kJump = 15, kFirstJump = 4;

struct Limb {
  Index upper = 0, lower = 0, end = 0;  // of the target
  Index sourceEnd = 0, sourceUpper = 0;
  double length = 0;                 // of both bones, target
  std::unique_ptr<IkSolver> solver;  // none: two-bone
};

struct Leg {
  Limb limb;
  std::optional<Index> toes, sourceToes;
  double ankleGround = 0, toesGround = 0;              // heights when standing, target
  double sourceAnkleGround = 0, sourceToesGround = 0;  // likewise, source
  PlantDetector anklePlant, toesPlant;
  FootLock lock;
  Vec3 goal = Vec3::Zero();
};

double smoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

class LimbIkRetargeter : public FrameRetargeter {
 public:
  explicit LimbIkRetargeter(const RetargetSetup& setup) : setup_(setup), aligned_(setup) {
    findIkMethod(setup.options.solver);
    for (const std::string side : {"left", "right"}) {
      if (auto leg = limb(side + "UpperLeg", side + "LowerLeg", side + "Foot")) addLeg(side, std::move(*leg));
      if (auto arm = limb(side + "UpperArm", side + "LowerArm", side + "Hand")) arms_.push_back(std::move(*arm));
    }
    if (const JointMatch* head = setup.map.find("head")) head_ = {head->source.front(), head->target.front()};
    active_ = setup.person && !isSame();
  }

  void next(const Pose& source, double seconds, Pose& target) override {
    aligned_.next(source, seconds, target);
    if (!active_) return;
    if (setup_.options.contacts) {
      feetGoals(seconds);
      sink(seconds, target);
      for (Leg& leg : legs_) reach(leg.limb, leg.goal, true, target);
    }
    handsGoals(target);
  }

 private:
  const BodyFrame& from() const { return aligned_.sourceFrame(); }
  BodyFrame& to() { return aligned_.targetFrame(); }

  // Nothing to correct where both neutral poses are one.
  bool isSame() const {
    const NeutralPose &a = setup_.sourceNeutral, &b = setup_.targetNeutral;
    if (a.positions.size() != b.positions.size() || std::abs(setup_.scale - 1) > 1e-9) return false;
    for (std::size_t j = 0; j < a.positions.size(); ++j) {
      if ((a.positions[j] - b.positions[j]).norm() > 1e-6 * setup_.targetHipHeight) return false;
    }
    return true;
  }

  std::optional<Limb> limb(const std::string& upper, const std::string& lower, const std::string& end) const {
    const JointMatch *u = setup_.map.find(upper), *l = setup_.map.find(lower), *e = setup_.map.find(end);
    if (!u || !l || !e) return std::nullopt;
    Limb limb;
    limb.upper = u->target.front();
    limb.lower = l->target.front();
    limb.end = e->target.front();
    limb.sourceUpper = u->source.front();
    limb.sourceEnd = e->source.front();
    if (!isAncestorOrSelf(*setup_.target, limb.upper, limb.lower)) return std::nullopt;
    if (!isAncestorOrSelf(*setup_.target, limb.lower, limb.end)) return std::nullopt;
    const std::vector<Vec3>& rest = setup_.targetNeutral.restPositions;
    const double upperLength = (rest[limb.lower] - rest[limb.upper]).norm();
    const double lowerLength = (rest[limb.end] - rest[limb.lower]).norm();
    if (!(upperLength > 0) || !(lowerLength > 0)) return std::nullopt;
    limb.length = upperLength + lowerLength;
    if (setup_.options.solver != "two-bone") {
      IkTarget goal;
      goal.joint = limb.end;
      goal.base = limb.upper;
      IkOptions options;
      options.restarts = 0;
      limb.solver = std::make_unique<IkSolver>(findIkMethod(setup_.options.solver), *setup_.target,
                                               std::span<const IkTarget>(&goal, 1), nullptr, options);
    }
    return limb;
  }

  void addLeg(const std::string& side, Limb limb) {
    const PlantDetector detector(setup_.sourceHipHeight);
    Leg leg{std::move(limb), {}, {}, 0, 0, 0, 0, detector, detector, {}, Vec3::Zero()};
    const std::vector<Vec3>&source = setup_.sourceNeutral.positions, &target = setup_.targetNeutral.positions;
    const auto lowest = [&](MapSide where, const std::vector<Vec3>& positions) {
      double y = std::numeric_limits<double>::infinity();
      for (const Index joint : soleJoints(setup_.map, where)) y = std::min(y, positions[joint].y());
      return y;
    };
    const double sourceLowest = lowest(MapSide::kSource, source), targetLowest = lowest(MapSide::kTarget, target);
    leg.ankleGround = setup_.targetGround + target[leg.limb.end].y() - targetLowest;
    leg.sourceAnkleGround = setup_.sourceGround + source[leg.limb.sourceEnd].y() - sourceLowest;
    if (const JointMatch* toes = setup_.map.find(side + "Toes")) {
      leg.toes = toes->target.front();
      leg.sourceToes = toes->source.front();
      leg.toesGround = setup_.targetGround + target[*leg.toes].y() - targetLowest;
      leg.sourceToesGround = setup_.sourceGround + source[*leg.sourceToes].y() - sourceLowest;
    }
    legs_.push_back(std::move(leg));
  }

  FootAnchor anchorOf(Leg& leg, double seconds) {
    const Vec3& ankle = from().positions[leg.limb.sourceEnd];
    const bool heel = leg.anklePlant.next(ankle, ankle.y() - leg.sourceAnkleGround, seconds);
    if (!leg.toes) return heel ? FootAnchor::kAnkle : FootAnchor::kNone;
    const Vec3& toes = from().positions[*leg.sourceToes];
    if (leg.toesPlant.next(toes, toes.y() - leg.sourceToesGround, seconds)) return FootAnchor::kToes;
    return heel ? FootAnchor::kAnkle : FootAnchor::kNone;
  }

  // Nobody moves that fast: what stood before the cut does not count behind it.
  void forgetAcrossCuts(double seconds) {
    std::vector<Vec3>& now = landmarks_[1];
    now.assign(1, pelvisOf(setup_.map, MapSide::kSource, from().positions));
    for (const Leg& leg : legs_) now.push_back(from().positions[leg.limb.sourceEnd]);
    const double jump = (frames_++ == 1 ? kFirstJump : kJump) * setup_.sourceHipHeight * seconds;
    bool cut = false;
    for (std::size_t i = 0; i < landmarks_[0].size(); ++i) {
      cut = cut || (now[i] - landmarks_[0][i]).norm() > jump;
    }
    std::swap(landmarks_[0], landmarks_[1]);
    if (!cut) return;
    sinking_ = 0;
    for (Leg& leg : legs_) {
      leg.anklePlant.reset();
      leg.toesPlant.reset();
      leg.lock.reset();
    }
  }

  void feetGoals(double seconds) {
    forgetAcrossCuts(seconds);
    for (Leg& leg : legs_) {
      FootLock::Frame frame;
      frame.ankle = to().positions[leg.limb.end];
      frame.toes = leg.toes ? to().positions[*leg.toes] : frame.ankle;
      frame.anchor = anchorOf(leg, seconds);
      frame.ankleGround = leg.ankleGround;
      frame.toesGround = leg.toesGround;
      leg.goal = leg.lock.next(frame, seconds, kFootSlack * setup_.targetHipHeight);
      double below = leg.ankleGround - leg.goal.y();
      if (leg.toes) below = std::max(below, leg.toesGround - (leg.goal + frame.toes - frame.ankle).y());
      leg.goal.y() += std::max(below, 0.0);
    }
  }

  // Lowers the pelvis so that every leg whose foot is held reaches it, and lets it rise again slowly.
  void sink(double seconds, Pose& target) {
    double needed = 0;
    for (const Leg& leg : legs_) {
      const Vec3 way = leg.goal - to().positions[leg.limb.upper];
      const double length = kStretch * leg.limb.length, across = std::hypot(way.x(), way.z());
      if (way.norm() <= length || way.y() >= 0) continue;
      const double down = std::sqrt(std::max(length * length - across * across, 0.0));
      needed = std::max(needed, -way.y() - down);
    }
    needed = std::min(needed, kMostSinking * setup_.targetHipHeight);
    sinking_ = std::max(needed, sinking_ * std::exp(-kSinkRate * seconds));
    if (sinking_ > 1e-9 * setup_.targetHipHeight) aligned_.root().movePelvis(Vec3(0, -sinking_, 0), target, to());
  }

  // Hands near each other, or near the head, keep the source's distance, scaled.
  void handsGoals(Pose& target) {
    if (arms_.empty()) return;
    std::array<Vec3, 2> goals;
    std::array<bool, 2> wanted = {false, false};
    for (std::size_t a = 0; a < arms_.size(); ++a) goals[a] = handGoal(arms_[a], wanted[a]);
    if (setup_.options.contacts && arms_.size() == 2) {
      const Vec3 apart = setup_.scale * (from().positions[arms_[1].sourceEnd] - from().positions[arms_[0].sourceEnd]);
      const double weight = closeness(apart.norm());
      const Vec3 change = 0.5 * weight * (apart - (goals[1] - goals[0]));
      goals[0] -= change;
      goals[1] += change;
      if (weight > 0) wanted = {true, true};
    }
    for (std::size_t a = 0; a < arms_.size(); ++a) {
      if (wanted[a]) reach(arms_[a], goals[a], false, target);
    }
  }

  double closeness(double distance) const {
    const double share = distance / setup_.targetHipHeight;
    return smoothStep((kApart - share) / (kApart - kTouching));
  }

  Vec3 handGoal(const Limb& arm, bool& wanted) {
    Vec3 goal = to().positions[arm.end];
    const double d = setup_.options.reach;
    if (d != 0) {
      const Vec3 pelvis = pelvisOf(setup_.map, MapSide::kSource, from().positions);
      const Vec3 there = setup_.placeOf(pelvis) + setup_.scale * (from().positions[arm.sourceEnd] - pelvis);
      goal += d * (there - goal);
      wanted = true;
    }
    if (setup_.options.contacts && head_) {
      const Vec3 fromHead = setup_.scale * (from().positions[arm.sourceEnd] - from().positions[head_->first]);
      const double weight = closeness(fromHead.norm());
      goal += weight * (to().positions[head_->second] + fromHead - goal);
      wanted = wanted || weight > 0;
    }
    return goal;
  }

  void reach(Limb& limb, const Vec3& goal, bool isLeg, Pose& target) {
    BodyFrame& frame = to();
    if ((goal - frame.positions[limb.end]).norm() < 1e-9 * limb.length) return;
    const Quat orientation = frame.rotations[limb.end];
    if (limb.solver) {
      reachBySolver(limb, goal, target);
    } else {
      turnTwoBones(limb, goal, isLeg, target);
    }
    // The end keeps its orientation.
    const BodyKinematics& kinematics = setup_.targetKinematics;
    kinematics.globals(target, frame);
    target.locals[limb.end].rotation =
        (kinematics.parentRotation(limb.end, frame).conjugate() * orientation).normalized();
    kinematics.globals(target, frame);
  }

  void turnTwoBones(const Limb& limb, const Vec3& goal, bool isLeg, Pose& target) {
    const BodyFrame& frame = to();
    TwoBone bones{frame.positions[limb.upper], frame.positions[limb.lower], frame.positions[limb.end], goal, {}, {}};
    if (isLeg) bones.pole = kneePole(limb, bones);
    const TwoBoneTurns turns = solveTwoBone(bones);
    const BodyKinematics& kinematics = setup_.targetKinematics;
    const Quat aboveUpper = kinematics.parentRotation(limb.upper, frame);
    const Quat aboveLower = turns.start * kinematics.parentRotation(limb.lower, frame);
    target.locals[limb.upper].rotation =
        (aboveUpper.conjugate() * turns.start * frame.rotations[limb.upper]).normalized();
    target.locals[limb.lower].rotation =
        (aboveLower.conjugate() * turns.middle * frame.rotations[limb.lower]).normalized();
  }

  // Knees bend to where they bend now, and forward where they hardly do.
  Vec3 kneePole(const Limb& limb, const TwoBone& bones) const {
    const Vec3 way = (bones.end - bones.start).normalized(), knee = bones.middle - bones.start;
    const Vec3 bend = knee - knee.dot(way) * way;
    const Quat turn =
        aligned_.targetFrame().rotations[limb.upper] * setup_.targetNeutral.rotations[limb.upper].conjugate();
    return bones.middle + bend + 0.02 * limb.length * (turn * Vec3::UnitZ());
  }

  void reachBySolver(Limb& limb, const Vec3& goal, Pose& target) {
    IkTarget wanted;
    wanted.joint = limb.end;
    wanted.base = limb.upper;
    wanted.position = setup_.targetNeutral.toBody.conjugate() * goal;
    limb.solver->solve(target, std::span<const IkTarget>(&wanted, 1));
  }

  const RetargetSetup& setup_;
  AlignedRetargeter aligned_;
  std::vector<Leg> legs_;
  std::vector<Limb> arms_;
  std::optional<std::pair<Index, Index>> head_;  // of source and target
  std::array<std::vector<Vec3>, 2> landmarks_;   // of the frame before, and room for this one's
  std::size_t frames_ = 0;
  double sinking_ = 0;
  bool active_ = true;
};

}  // namespace

std::unique_ptr<FrameRetargeter> makeLimbIk(const RetargetSetup& setup) {
  return std::make_unique<LimbIkRetargeter>(setup);
}

}  // namespace limber
