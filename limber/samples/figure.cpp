#include "limber/samples/figure.h"

#include <algorithm>
#include <string>
#include <utility>

#include "limber/core/text/numbers.h"
#include "limber/skeleton/ik/solvers/two_bone.h"

namespace limber {

namespace {

struct BoneStart {
  const char *name, *parent;
  Vec3 position;  // metres; of a side's bones the left one's
};

const BoneStart kPersonTrunk[] = {{"hips", "", {0, 0.94, 0}},        {"spine", "hips", {0, 1.05, 0}},
                                  {"chest", "spine", {0, 1.22, 0}},  {"neck", "chest", {0, 1.45, 0}},
                                  {"head", "neck", {0, 1.54, 0.01}}, {"head_end", "head", {0, 1.72, 0.01}}};
const BoneStart kPersonSides[] = {{"UpperLeg", "hips", {0.09, 0.90, 0}},     {"LowerLeg", "UpperLeg", {0.09, 0.49, 0}},
                                  {"Foot", "LowerLeg", {0.09, 0.09, 0}},     {"Toes", "Foot", {0.09, 0.025, 0.12}},
                                  {"Toes_end", "Toes", {0.09, 0.02, 0.19}},  {"Shoulder", "chest", {0.03, 1.40, 0}},
                                  {"UpperArm", "Shoulder", {0.17, 1.41, 0}}, {"LowerArm", "UpperArm", {0.45, 1.41, 0}},
                                  {"Hand", "LowerArm", {0.70, 1.41, 0}},     {"Hand_end", "Hand", {0.86, 1.41, 0}}};
const Vec3 kHipsToPelvis(0, -0.04, 0);

void addBone(const std::string& prefix, double side, const BoneStart& bone, Skeleton& skeleton,
             std::vector<Vec3>& positions) {
  Joint& joint = skeleton.joints.emplace_back();
  joint.name = prefix + bone.name;
  const std::string parent = bone.parent;
  joint.parent = skeleton.find(parent);
  if (!joint.parent) joint.parent = skeleton.find(prefix + parent);
  positions.emplace_back(side * bone.position.x(), bone.position.y(), bone.position.z());
  joint.rest.translation = joint.parent ? Vec3(positions.back() - positions[*joint.parent]) : positions.back();
}

Quat about(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

Vec3 mirroredOffset(const Vec3& v) {
  return {-v.x(), v.y(), v.z()};
}

Quat footTurn(const FootPose& foot) {
  return about(Vec3::UnitY(), foot.outward) * about(Vec3::UnitX(), -foot.pitch);
}

// Sets joints by how they stand in the world, parents first.
class Poser {
 public:
  explicit Poser(const Skeleton& figure)
      : figure_(figure), pose_(restPose(figure)), rotations_(pose_.locals.size(), Quat::Identity()) {}

  void turn(const std::string& name, const Quat& world) {
    const Index joint = figure_.find(name).value();
    rotations_[joint] = world;
    const auto& parent = figure_.joints[joint].parent;
    pose_.locals[joint].rotation = parent ? Quat(rotations_[*parent].conjugate() * world) : world;
  }
  const Vec3& offset(const std::string& name) const {
    return figure_.joints[figure_.find(name).value()].rest.translation;
  }
  Pose& pose() { return pose_; }

 private:
  const Skeleton& figure_;
  Pose pose_;
  std::vector<Quat> rotations_;
};

void poseLeg(const Stance& stance, const std::string& side, Poser& poser) {
  const bool left = side == "left";
  const FootPose& foot = stance.feet[left ? 0 : 1];
  const auto toSide = [&](const Vec3& v) { return left ? v : mirroredOffset(v); };
  const auto turnToSide = [&](const Quat& q) { return left ? q : Quat(q.w(), q.x(), -q.y(), -q.z()); };
  TwoBone leg;
  const Quat hips = rotationOf(stance.hips);
  leg.start = stance.pelvis + hips * Vec3(poser.offset(side + "UpperLeg").x(), 0, 0);
  leg.middle = leg.start + hips * poser.offset(side + "LowerLeg");
  leg.end = leg.middle + hips * poser.offset(side + "Foot");
  leg.target = toSide(foot.ankle);
  leg.straightNormal = hips * Vec3::UnitX();  // a leg at rest is straight
  leg.pole = leg.start + turnToSide(about(Vec3::UnitY(), foot.outward)) * Vec3::UnitZ();
  const TwoBoneTurns turns = solveTwoBone(leg);
  poser.turn(side + "UpperLeg", turns.start * hips);
  poser.turn(side + "LowerLeg", turns.middle * hips);
  poser.turn(side + "Foot", turnToSide(footTurn(foot)));
  poser.turn(side + "Toes", turnToSide(footTurn(foot) * about(Vec3::UnitX(), -foot.toes)));
}

void poseArm(const Stance& stance, const std::string& side, Poser& poser) {
  const bool left = side == "left";
  const ArmPose& arm = stance.arms[left ? 0 : 1];
  const auto turnToSide = [&](const Quat& q) { return left ? q : Quat(q.w(), q.x(), -q.y(), -q.z()); };
  const Quat chest = rotationOf(stance.chest);
  // The collar takes a part of what lifts the arm.
  poser.turn(side + "Shoulder", chest * turnToSide(about(Vec3::UnitZ(), 0.15 * std::max(arm.raise - kPi / 4, 0.0))));
  const Quat upper =
      about(Vec3::UnitX(), -arm.swing) * about(Vec3::UnitZ(), arm.raise - kPi / 2) * about(Vec3::UnitX(), -arm.twist);
  poser.turn(side + "UpperArm", chest * turnToSide(upper));
  const Quat lower = upper * about(Vec3::UnitY(), -arm.elbow);
  poser.turn(side + "LowerArm", chest * turnToSide(lower));
  poser.turn(side + "Hand", chest * turnToSide(lower));
}

}  // namespace

Skeleton figureSkeleton() {
  Skeleton skeleton;
  std::vector<Vec3> positions;
  for (const BoneStart& bone : kPersonTrunk) addBone("", 1, bone, skeleton, positions);
  for (const BoneStart& bone : kPersonSides) addBone("left", 1, bone, skeleton, positions);
  for (const BoneStart& bone : kPersonSides) addBone("right", -1, bone, skeleton, positions);
  return skeleton;
}

Quat rotationOf(const BodyTurn& turn) {
  return about(Vec3::UnitY(), turn.yaw) * about(Vec3::UnitX(), turn.pitch) * about(Vec3::UnitZ(), turn.roll);
}

Vec3 turnedFoot(const FootPose& foot, const Vec3& toPoint) {
  return footTurn(foot) * toPoint;
}

Pose poseOf(const Skeleton& figure, const Stance& stance) {
  Poser poser(figure);
  const Quat hips = rotationOf(stance.hips), chest = rotationOf(stance.chest), head = rotationOf(stance.head);
  poser.pose().locals[figure.find("hips").value()].translation = stance.pelvis - hips * kHipsToPelvis;
  poser.turn("hips", hips);
  poser.turn("spine", hips.slerp(0.5, chest));
  poser.turn("chest", chest);
  poser.turn("neck", chest.slerp(0.5, head));
  poser.turn("head", head);
  for (const char* side : {"left", "right"}) {
    poseLeg(stance, side, poser);
    poseArm(stance, side, poser);
  }
  return std::move(poser.pose());
}

}  // namespace limber
