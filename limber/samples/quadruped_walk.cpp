// The sample motion "quadruped-walk", for skeletons of the template quadruped. Each leg stands for 65 % of a stride;
// left hind, left front, right hind and right front leg follow each other by a quarter (Muybridge's lateral sequence).
#include <cmath>
#include <string>

#include "limber/core/numbers.h"
#include "limber/ik/two_bone.h"
#include "limber/samples/motion_recipes.h"
#include "limber/samples/smooth_way.h"

namespace limber {

namespace {

constexpr double kQuadrupedStride = 0.20, kQuadrupedStrideSeconds = 0.9, kStands = 0.65;  // metres; share of the stride
constexpr double kSinks = 0.016, kPawLift = 0.022;                                        // metres

struct QuadrupedBone {
  const char *name, *parent;
  Vec3 position;  // metres; of a side's bones the left one's
};

const QuadrupedBone kQuadrupedTrunk[] = {{"hips", "", {0, 0.367, -0.17}},       {"spine", "hips", {0, 0.352, -0.076}},
                                         {"spine1", "spine", {0, 0.35, 0.018}}, {"chest", "spine1", {0, 0.345, 0.112}},
                                         {"neck", "chest", {0, 0.42, 0.212}},   {"neck1", "neck", {0, 0.485, 0.24}},
                                         {"head", "neck1", {0, 0.551, 0.268}},  {"tail", "hips", {0, 0.379, -0.235}},
                                         {"tail1", "tail", {0, 0.389, -0.39}},  {"tail2", "tail1", {0, 0.45, -0.5}}};
const QuadrupedBone kQuadrupedSides[] = {{"FrontShoulder", "chest", {0.041, 0.327, 0.138}},
                                         {"FrontUpperLeg", "FrontShoulder", {0.072, 0.291, 0.155}},
                                         {"FrontLowerLeg", "FrontUpperLeg", {0.075, 0.157, 0.159}},
                                         {"FrontFoot", "FrontLowerLeg", {0.076, 0.044, 0.171}},
                                         {"FrontToes", "FrontFoot", {0.076, 0.015, 0.175}},
                                         {"HindUpperLeg", "hips", {0.07, 0.345, -0.156}},
                                         {"HindLowerLeg", "HindUpperLeg", {0.07, 0.245, -0.125}},
                                         {"HindFoot", "HindLowerLeg", {0.08, 0.135, -0.201}},
                                         {"HindToes", "HindFoot", {0.081, 0.035, -0.173}}};

double sineWave(double phase) {
  return std::sin(2 * kPi * phase);
}

Quat turnAbout(const Vec3& axis, double angle) {
  return Quat(Eigen::AngleAxisd(angle, axis));
}

// How far the last bone leans forward over its toes, radians: more and more while it stands, then back in the air.
double leanAt(double phase, bool front) {
  const double standing =
      front ? 0.45 * smoothRise((phase - 0.35) / (kStands - 0.35)) : 0.5 * smoothRise(phase / kStands) - 0.2;
  const double swing = (phase - kStands) / (1 - kStands);
  const double most = front ? 0.45 : 0.5;
  return standing - most * smoothRise(swing) + (front ? 0.5 : 0.35) * smoothBump(swing);
}

// Of the toes, against where they are in rest pose on a body that has not moved.
Vec3 toesWay(double strides) {
  const double count = std::floor(strides), phase = strides - count;
  const double swing = (phase - kStands) / (1 - kStands);
  return {0, kPawLift * smoothBump(swing), (count + 0.5 * kStands + smoothRise(swing)) * kQuadrupedStride};
}

class Walker {
 public:
  Walker(const Skeleton& skeleton, double seconds)
      : skeleton_(skeleton),
        pose_(restPose(skeleton)),
        rest_(restGlobals(skeleton)),
        strides_(seconds / kQuadrupedStrideSeconds) {}

  Pose walk() {
    moveTrunk();
    globals_ = poseGlobals(skeleton_, pose_);
    moveLeg("leftHind", 0);
    moveLeg("leftFront", 0.25);
    moveLeg("rightHind", 0.5);
    moveLeg("rightFront", 0.75);
    return pose_;
  }

 private:
  Index joint(const std::string& name) const { return skeleton_.find(name).value(); }
  void turn(const char* name, double pitch, double yaw, double roll) {
    pose_.locals[joint(name)].rotation =
        turnAbout(Vec3::UnitY(), yaw) * turnAbout(Vec3::UnitX(), pitch) * turnAbout(Vec3::UnitZ(), roll);
  }

  // The hips swing with the hind legs, the chest against them; the head and the tail follow.
  void moveTrunk() {
    const double swing = sineWave(strides_ + 0.1), bob = sineWave(2 * strides_ + 0.1);
    pose_.locals[0].translation += Vec3(0.004 * swing, 0.003 * bob - kSinks, kQuadrupedStride * strides_);
    turn("hips", 0.01 * bob, -0.06 * swing, 0.04 * swing);
    turn("spine", 0, 0.04 * swing, -0.02 * swing);
    turn("spine1", 0, 0.04 * swing, -0.02 * swing);
    turn("chest", -0.01 * bob, 0.02 * swing, 0);
    turn("neck", 0.03 * sineWave(2 * strides_ - 0.1), -0.02 * swing, 0);
    turn("head", -0.03 * sineWave(2 * strides_ - 0.15), -0.02 * swing, 0);
    turn("tail", 0, 0.12 * sineWave(strides_ - 0.05), 0);
    turn("tail1", 0, 0.14 * sineWave(strides_ - 0.15), 0);
    turn("tail2", 0, 0.16 * sineWave(strides_ - 0.25), 0);
  }

  void moveLeg(const std::string& leg, double behind) {
    const bool front = leg.ends_with("Front");
    const double strides = strides_ - behind;
    const double lean = leanAt(strides - std::floor(strides), front);
    const Index upper = joint(leg + "UpperLeg"), lower = joint(leg + "LowerLeg"), foot = joint(leg + "Foot"),
                toes = joint(leg + "Toes");
    const auto resting = [&](Index j) -> Vec3 { return rest_[j].translation(); };
    const Vec3 stands = resting(toes) + toesWay(strides) + Vec3(0, 0, behind * kQuadrupedStride);
    const Quat leaning = turnAbout(Vec3::UnitX(), lean);
    TwoBone bones;
    bones.start = globals_[upper].translation();
    bones.middle = globals_[lower].translation();
    bones.end = globals_[foot].translation();
    bones.target = stands - leaning * Vec3(resting(toes) - resting(foot));
    bones.pole = bones.start + Vec3(0, -0.1, front ? -1 : 1);
    const TwoBoneTurns turns = solveTwoBone(bones);
    const Quat above(globals_[*skeleton_.joints[upper].parent].linear()), body(globals_[upper].linear());
    const Quat upperTurn = turns.start * body, lowerTurn = turns.middle * body;
    pose_.locals[upper].rotation = above.conjugate() * upperTurn;
    pose_.locals[lower].rotation = upperTurn.conjugate() * lowerTurn;
    pose_.locals[foot].rotation = lowerTurn.conjugate() * leaning;
    // Flat while they stand, hanging a little in the air.
    const double swing = (strides - std::floor(strides) - kStands) / (1 - kStands);
    pose_.locals[toes].rotation = turnAbout(Vec3::UnitX(), -lean * (1 - 0.7 * smoothBump(swing)));
  }

  const Skeleton& skeleton_;
  Pose pose_;
  std::vector<Affine> rest_, globals_;
  double strides_;
};

}  // namespace

Skeleton quadrupedSkeleton() {
  Skeleton skeleton;
  std::vector<Vec3> positions;
  const auto add = [&](const std::string& prefix, double side, const QuadrupedBone& bone) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = prefix + bone.name;
    joint.parent = skeleton.find(bone.parent);
    if (!joint.parent) joint.parent = skeleton.find(prefix + bone.parent);
    positions.emplace_back(side * bone.position.x(), bone.position.y(), bone.position.z());
    joint.rest.translation = joint.parent ? Vec3(positions.back() - positions[*joint.parent]) : positions.back();
  };
  for (const QuadrupedBone& bone : kQuadrupedTrunk) add("", 1, bone);
  for (const QuadrupedBone& bone : kQuadrupedSides) add("left", 1, bone);
  for (const QuadrupedBone& bone : kQuadrupedSides) add("right", -1, bone);
  return skeleton;
}

Pose quadrupedWalkAt(const Skeleton& quadruped, double seconds) {
  return Walker(quadruped, seconds).walk();
}

}  // namespace limber
