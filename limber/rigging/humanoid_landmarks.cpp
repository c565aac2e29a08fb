#include "limber/rigging/humanoid_landmarks.h"

#include <array>
#include <string>

#include "limber/rigging/body_section.h"
#include "limber/rigging/leg_finder.h"

namespace limber {

namespace {

// Heights, but for shares.
constexpr double kSeedReach = 0.04;
constexpr double kWidestArm = 0.03;  // square heights of a cut
constexpr double kMostMoved = 0.06;

struct Arm {
  Index shoulder = 0, elbow = 0, hand = 0;
};

struct HumanoidJoints {
  std::array<Leg, 2> legs;
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
  }
  set(joints.hips, "hips");
  set(joints.upperChest, "upperChest");
  set(joints.neck, "neck");
  set(joints.head, "head");
  return all ? std::optional(joints) : std::nullopt;
}

// Moves what may be moved.
class Mover {
 public:
  Mover(const BodyVolume& body, const BodyFrame& frame, const std::vector<std::optional<Vec3>>& pins,
        std::vector<Vec3>& places, const HumanoidProportions& proportions)
      : body_(body), frame_(frame), pins_(pins), places_(places), proportions_(proportions) {}

  void legs(const HumanoidJoints& joints) {
    LegFinder finder(body_, frame_, places_, joints.legs[0], joints.legs[1]);
    const bool parted = finder.findParting();
    if (!finder.known()) return;
    for (int side = 0; side < 2; ++side) {
      const Leg& leg = joints.legs[side];
      double hipY = places_[leg.hip].y();
      if (parted) {
        hipY = finder.parting() + proportions_.hipAboveParting * finder.halfWidth(side);
        moveTo(leg.hip, finder.middle(side, hipY));
      }
      const double ankleY = proportions_.ankle + proportions_.ankleShare * hipY;
      moveTo(leg.ankle, finder.middle(side, ankleY));
      moveTo(leg.knee, finder.middle(side, hipY + proportions_.knee * (ankleY - hipY)));
    }
    const Vec3 between = 0.5 * (places_[joints.legs[0].hip] + places_[joints.legs[1].hip]);
    if (parted) moveTo(joints.hips, {places_[joints.hips].x(), between.y() - proportions_.hipsBelow, between.z()});
  }

  // Elbow and hand to the middle of the arm; the shoulder on in the direction from the elbow to the middle of the upper
  // arm, as far as it was.
  void arm(const Arm& arm) {
    const Vec3 shoulder = places_[arm.shoulder], elbow = places_[arm.elbow], hand = places_[arm.hand];
    const double upper = (elbow - shoulder).norm();
    if (upper < 1e-3 || (hand - elbow).norm() < 1e-3) return;
    const Vec3 along = (elbow - shoulder).normalized(), below = (hand - elbow).normalized();
    const std::optional<Vec3> middle = middleAt(0.45 * shoulder + 0.55 * elbow, along);
    const std::optional<Vec3> atElbow = middleAt(elbow, (along + below).normalized());
    const std::optional<Vec3> atHand = middleAt(hand, below);
    if (atHand) moveTo(arm.hand, *atHand);
    if (!atElbow) return;
    moveTo(arm.elbow, *atElbow);
    if (!middle || (*middle - *atElbow).norm() < 0.3 * upper) return;
    moveTo(arm.shoulder, *atElbow + upper * (*middle - *atElbow).normalized());
  }

  void trunk(const HumanoidJoints& joints) {
    const double shoulders = 0.5 * (places_[joints.arms[0].shoulder].y() + places_[joints.arms[1].shoulder].y());
    Vec3 neck = places_[joints.neck], head = places_[joints.head], chest = places_[joints.upperChest];
    const double hips = places_[joints.hips].y();
    neck.y() = shoulders + proportions_.neckAboveShoulders;
    head.y() = neck.y() + proportions_.headAboveNeck;
    chest.y() = hips + proportions_.upperChest * (neck.y() - hips);
    for (Vec3* place : {&chest, &neck}) {
      const BodySection section = sectionAt(body_, frame_, *place, Vec3::UnitY(), kSeedReach);
      if (!section.empty()) place->z() = section.center.z();
    }
    head.z() = 0.5 * (head.z() + neck.z());
    moveTo(joints.upperChest, chest);
    moveTo(joints.neck, neck);
    moveTo(joints.head, head);
  }

 private:
  void moveTo(Index joint, const Vec3& place) {
    if (!pins_[joint]) places_[joint] = place;
  }

  // None where the cut goes through more than an arm.
  std::optional<Vec3> middleAt(const Vec3& place, const Vec3& normal) const {
    const BodySection section = sectionAt(body_, frame_, place, normal, kSeedReach);
    if (section.empty() || section.area > kWidestArm || (section.center - place).norm() > kMostMoved)
      return std::nullopt;
    return section.center;
  }

  const BodyVolume& body_;
  const BodyFrame& frame_;
  const std::vector<std::optional<Vec3>>& pins_;
  std::vector<Vec3>& places_;
  const HumanoidProportions& proportions_;
};

}  // namespace

void refineHumanoid(const TemplateSkeleton& skeleton, const BodyVolume& body, const BodyFrame& frame,
                    const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& places,
                    const HumanoidProportions& proportions) {
  const std::optional<HumanoidJoints> joints = humanoidJointsOf(skeleton);
  if (!joints) return;
  Mover mover(body, frame, pins, places, proportions);
  mover.legs(*joints);
  for (const Arm& arm : joints->arms) mover.arm(arm);
  mover.trunk(*joints);
}

}  // namespace limber
