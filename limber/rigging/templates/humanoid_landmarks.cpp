#include "limber/rigging/templates/humanoid_landmarks.h"

#include <algorithm>
#include <array>
#include <string>

#include "limber/rigging/body/arm_finder.h"
#include "limber/rigging/body/body_section.h"
#include "limber/rigging/body/leg_finder.h"

namespace limber {

namespace {

// Heights, except for fractions.
constexpr double kSeedReach = 0.04;
constexpr double kWidestArm = 0.03;  // square heights of a cut
constexpr double kMaxMoved = 0.06;
constexpr double kUpright = 0.85;      // least cosine
constexpr double kLifted = 0.12;       // of a foot that does not stand
constexpr double kWristSearch = 0.2;   // of the arm's length, to both sides
constexpr double kElbowSearch = 0.08;  // of the arm's length, to both sides
constexpr double kHanging = 0.755;     // cosine between upper arm and straight down
constexpr double kStraightArm = 0.9;   // cosine between upper arm and forearm from which the bend shows no elbow

struct Arm {
  Index shoulder = 0, elbow = 0, hand = 0;
  std::optional<Index> tip;
};

struct HumanoidJoints {
  std::array<LegChain, 2> legs;
  std::array<Arm, 2> arms;
  Index hips = 0, upperChest = 0, neck = 0, head = 0;
};

std::optional<HumanoidJoints> humanoidJointsOf(const TemplateSkeleton& skeleton) {
  HumanoidJoints joints;
  bool all = true;
  const auto set = [&](Index& joint, const std::string& name) {
    const std::optional<Index> found = skeleton.find(name);
    all = all && found;
    joint = found.value_or(0);
  };
  const char* sides[2] = {"left", "right"};
  for (int side = 0; side < 2; ++side) {
    const std::string of = sides[side];
    set(joints.legs[side].hip, of + "UpperLeg");
    set(joints.legs[side].knee, of + "LowerLeg");
    set(joints.legs[side].ankle, of + "Foot");
    set(joints.arms[side].shoulder, of + "UpperArm");
    set(joints.arms[side].elbow, of + "LowerArm");
    set(joints.arms[side].hand, of + "Hand");
    joints.arms[side].tip = skeleton.find(of + "HandTip");
  }
  set(joints.hips, "hips");
  set(joints.upperChest, "upperChest");
  set(joints.neck, "neck");
  set(joints.head, "head");
  return all ? std::optional(joints) : std::nullopt;
}

// Moves what may be moved.
class HumanoidMover {
 public:
  HumanoidMover(const BodyVolume& body, const AnatomicalFrame& frame, const std::vector<std::optional<Vec3>>& pins,
                std::vector<Vec3>& positions, const HumanoidProportions& proportions)
      : body_(body), frame_(frame), pins_(pins), positions_(positions), proportions_(proportions) {}

  bool isUpright(Index low, Index high) const {
    return (positions_[high] - positions_[low]).normalized().y() > kUpright;
  }

  // Whether cuts at rising heights follow both legs from the ground.
  bool restsOn(const std::array<LegChain, 2>& legs) const {
    return std::all_of(legs.begin(), legs.end(), [&](const LegChain& leg) {
      return isUpright(leg.ankle, leg.knee) && isUpright(leg.knee, leg.hip) && positions_[leg.ankle].y() < kLifted;
    });
  }

  void legs(const HumanoidJoints& joints) {
    LegFinder finder(body_, frame_, positions_, joints.legs[0], joints.legs[1]);
    const bool parted = finder.findParting();
    if (!finder.known()) return;
    for (int side = 0; side < 2; ++side) {
      const LegChain& leg = joints.legs[side];
      double hipY = positions_[leg.hip].y();
      if (parted) {
        hipY = finder.parting() + proportions_.hipAboveParting * finder.halfWidth(side);
        moveTo(leg.hip, finder.middle(side, hipY));
      } else if (const Vec3 middle = finder.middle(side, hipY); (middle - positions_[leg.hip]).norm() < kMaxMoved) {
        moveTo(leg.hip, middle);
      }
      const double ankleY = proportions_.ankle + proportions_.ankleFraction * hipY;
      moveTo(leg.ankle, finder.middle(side, ankleY));
      Vec3 knee = finder.middle(side, hipY + proportions_.knee * (ankleY - hipY));
      knee.z() += proportions_.kneeForward * finder.halfDepth(side, knee.y());
      moveTo(leg.knee, knee);
    }
    const Vec3 between = 0.5 * (positions_[joints.legs[0].hip] + positions_[joints.legs[1].hip]);
    if (parted) moveTo(joints.hips, {positions_[joints.hips].x(), between.y() - proportions_.hipsBelow, between.z()});
  }

  // Both arms are as long as the longer: what a hand holds rather keeps its joint from the hand than draws it beyond.
  void evenOut(const std::array<Arm, 2>& arms) {
    double lengths[2];
    for (int side = 0; side < 2; ++side) {
      const Arm& arm = arms[side];
      if (pins_[arm.shoulder] || pins_[arm.elbow] || pins_[arm.hand]) return;
      lengths[side] = (positions_[arm.elbow] - positions_[arm.shoulder]).norm() +
                      (positions_[arm.hand] - positions_[arm.elbow]).norm();
    }
    const int side = lengths[0] < lengths[1] ? 0 : 1;
    if (!(lengths[side] > 1e-3)) return;
    const double stretch = lengths[1 - side] / lengths[side];
    const Vec3 shoulder = positions_[arms[side].shoulder];
    for (const Index joint : {arms[side].elbow, arms[side].hand}) {
      positions_[joint] = shoulder + stretch * (positions_[joint] - shoulder);
    }
  }

  // Elbow and hand go to the middle of the arm and along it to where it shows them; the shoulder goes on in the
  // direction of the upper arm.
  void arm(const Arm& arm) {
    const Vec3 shoulder = positions_[arm.shoulder], below = (positions_[arm.hand] - positions_[arm.elbow]).normalized();
    const Vec3 along = (positions_[arm.elbow] - shoulder).normalized();
    Vec3 elbow = positions_[arm.elbow], hand = positions_[arm.hand];
    if (const auto middle = middleAt(hand, below)) hand = *middle;
    if (const auto middle = middleAt(elbow, (along + below).normalized())) elbow = *middle;
    const ArmFinder finder(body_, frame_, shoulder, elbow, hand);
    const double length = finder.hand();
    const double wrist =
        finder.narrowest(length - kWristSearch * length, length + kWristSearch * length).value_or(length);
    // Shapes and proportions are off to either side as often: the shoulder goes between what they say. An arm that
    // hangs touches the trunk below its shoulder.
    const bool hangs = along.y() < -kHanging;
    const double start = finder.armpit() && !hangs ? 0.5 * (*finder.armpit() - 0.5 * finder.radius()) : 0;
    double bend = finder.elbow();
    if (along.dot(below) > kStraightArm) {
      bend = 0.5 * (bend + start + proportions_.elbow * (wrist - start));
      bend = finder.narrowest(bend - kElbowSearch * length, bend + kElbowSearch * length).value_or(bend);
    }
    const Vec3 bent = finder.middle(bend).value_or(elbow);
    moveHand(arm, finder.middle(wrist).value_or(hand), below);
    moveTo(arm.elbow, bent);
    const double seen = finder.armpit().value_or(0) + finder.radius();
    const std::optional<Vec3> upper = finder.middle(std::max(seen, 0.45 * finder.elbow()));
    Vec3 inwards = (elbow - hand).normalized();
    if (upper && (*upper - bent).norm() > 0.3 * finder.elbow()) inwards = (*upper - bent).normalized();
    moveTo(arm.shoulder, bent + (bend - start) * inwards);
  }

  void trunk(const HumanoidJoints& joints) {
    const double shoulders = 0.5 * (positions_[joints.arms[0].shoulder].y() + positions_[joints.arms[1].shoulder].y());
    Vec3 neck = positions_[joints.neck], head = positions_[joints.head], chest = positions_[joints.upperChest];
    const double hips = positions_[joints.hips].y();
    neck.y() = shoulders + proportions_.neckAboveShoulders;
    head.y() = neck.y() + proportions_.headAboveNeck;
    chest.y() = hips + proportions_.upperChest * (neck.y() - hips);
    for (Vec3* position : {&chest, &neck}) {
      const BodySection section = sectionAt(body_, frame_, *position, Vec3::UnitY(), kSeedReach);
      if (section.empty()) continue;
      position->z() = section.center.z();
      if (position == &chest) chest.z() -= proportions_.chestBack * section.halfDepth();
    }
    head.z() = 0.5 * (head.z() + neck.z());
    moveTo(joints.upperChest, chest);
    moveTo(joints.neck, neck);
    moveTo(joints.head, head);
  }

 private:
  // The tip goes along where it would no longer be well beyond the hand in the direction of the forearm.
  void moveHand(const Arm& arm, const Vec3& position, const Vec3& forearm) {
    const Vec3 before = before_[arm.hand];
    moveTo(arm.hand, position);
    if (!arm.tip) return;
    const Vec3 moved = positions_[arm.hand] - before;
    const double was = (positions_[*arm.tip] - before).dot(forearm);
    if (moved.dot(forearm) > 0.5 * was) moveTo(*arm.tip, positions_[*arm.tip] + moved);
  }

  void moveTo(Index joint, const Vec3& position) {
    if (!pins_[joint]) positions_[joint] = position;
  }

  // None where the cut goes through more than an arm.
  std::optional<Vec3> middleAt(const Vec3& position, const Vec3& normal) const {
    const BodySection section = sectionAt(body_, frame_, position, normal, kSeedReach);
    if (section.empty() || section.area > kWidestArm || (section.center - position).norm() > kMaxMoved)
      return std::nullopt;
    return section.center;
  }

  const BodyVolume& body_;
  const AnatomicalFrame& frame_;
  const std::vector<std::optional<Vec3>>& pins_;
  std::vector<Vec3>& positions_;
  const std::vector<Vec3> before_ = positions_;  // as it was before anything moved
  const HumanoidProportions& proportions_;
};

}  // namespace

void refineHumanoid(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                    const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& positions,
                    const HumanoidProportions& proportions) {
  const std::optional<HumanoidJoints> joints = humanoidJointsOf(skeleton);
  if (!joints) return;
  HumanoidMover mover(body, frame, pins, positions, proportions);
  if (mover.restsOn(joints->legs)) mover.legs(*joints);
  mover.evenOut(joints->arms);
  for (const Arm& arm : joints->arms) mover.arm(arm);
  if (mover.isUpright(joints->hips, joints->neck)) mover.trunk(*joints);
}

}  // namespace limber
