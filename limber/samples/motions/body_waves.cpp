// Motions of bodies without legs under them: waves that run along a chain of joints, for skeletons of the templates
// fish, serpent and bird. A fish bends sideways by a wave that grows towards its tail (Lighthill: Note on the swimming
// of slender fish, 1960); a snake lies on a serpenoid curve and moves along it, so that no part slides sideways
// (Hirose: Biologically Inspired Robots, 1993); a bird's wings bend up late and down late, as their tips follow their
// roots.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/skeleton/placed_skeleton.h"

namespace limber {

namespace {

struct WaveBone {
  const char *name, *parent;
  Vec3 position;  // metres; of a side's bones the left one's
};

// Sides stand once, for the left. The rest pose turns nothing.
template <std::size_t N>
Skeleton skeletonOf(const WaveBone (&bones)[N]) {
  PlacedSkeleton skeleton;
  const auto rightOf = [](std::string name) { return name.starts_with("left") ? "right" + name.substr(4) : name; };
  for (const WaveBone& bone : bones) {
    skeleton.add(bone.name, bone.parent, bone.position);
    if (rightOf(bone.name) != bone.name) {
      skeleton.add(rightOf(bone.name), rightOf(bone.parent), bone.position.cwiseProduct(Vec3(-1, 1, 1)));
    }
  }
  return skeleton.take();
}

const WaveBone kFish[] = {{"chest", "", {0, 0.5, 0.2}},
                          {"head", "chest", {0, 0.5, 0.35}},
                          {"head_end", "head", {0, 0.5, 0.5}},
                          {"spine", "chest", {0, 0.5, 0.08}},
                          {"tail", "spine", {0, 0.5, -0.06}},
                          {"tail1", "tail", {0, 0.5, -0.2}},
                          {"tail2", "tail1", {0, 0.5, -0.34}},
                          {"leftFin", "chest", {0.08, 0.45, 0.15}},
                          {"leftFin_end", "leftFin", {0.2, 0.4, 0.05}}};

const WaveBone kSerpent[] = {
    {"chest", "", {0, 0.03, 0.31}},        {"neck", "chest", {0, 0.03, 0.38}},   {"head", "neck", {0, 0.03, 0.44}},
    {"head_end", "head", {0, 0.03, 0.5}},  {"spine", "chest", {0, 0.03, 0.24}},  {"spine1", "spine", {0, 0.03, 0.16}},
    {"spine2", "spine1", {0, 0.03, 0.08}}, {"spine3", "spine2", {0, 0.03, 0}},   {"tail", "spine3", {0, 0.03, -0.08}},
    {"tail1", "tail", {0, 0.03, -0.16}},   {"tail2", "tail1", {0, 0.03, -0.24}}, {"tail3", "tail2", {0, 0.03, -0.32}},
    {"tail4", "tail3", {0, 0.03, -0.4}}};

// In the air, with its legs drawn up.
const WaveBone kBirdBones[] = {{"hips", "", {0, 1, -0.1}},
                               {"chest", "hips", {0, 1.02, 0.08}},
                               {"neck", "chest", {0, 1.08, 0.2}},
                               {"head", "neck", {0, 1.12, 0.3}},
                               {"head_end", "head", {0, 1.1, 0.42}},
                               {"tail", "hips", {0, 1, -0.25}},
                               {"tail_end", "tail", {0, 1, -0.5}},
                               {"leftUpperWing", "chest", {0.08, 1.04, 0.08}},
                               {"leftLowerWing", "leftUpperWing", {0.35, 1.04, 0.06}},
                               {"leftWingHand", "leftLowerWing", {0.65, 1.04, 0.02}},
                               {"leftWingHand_end", "leftWingHand", {1.0, 1.04, -0.08}},
                               {"leftUpperLeg", "hips", {0.06, 0.92, -0.08}},
                               {"leftLowerLeg", "leftUpperLeg", {0.06, 0.8, -0.05}},
                               {"leftFoot", "leftLowerLeg", {0.06, 0.7, -0.1}},
                               {"leftFoot_end", "leftFoot", {0.06, 0.68, 0}}};

Quat yaw(double radians) {
  return Quat(Eigen::AngleAxisd(radians, Vec3::UnitY()));
}

constexpr double kSwimSeconds = 0.8, kSwimMetres = 0.5;             // of a beat of the tail
constexpr double kSwimWave = 1.1;                                   // metres from crest to crest
constexpr double kSwimHead = 0.03, kSwimTail = 0.11;                // metres to each side
constexpr double kSlitherSeconds = 1.2, kSlitherWave = 0.6;         // metres along the body from crest to crest
constexpr double kSlitherAngle = 0.75;                              // radians, of the body to its direction of travel
constexpr double kFlapSeconds = 0.7, kFlap = 0.6, kFlapBob = 0.04;  // radians up and down; metres

// To the side at z, and its slope, of the wave through a fish.
double swimSlope(double z, double phase) {
  const auto side = [&](double at) {
    const double grown = kSwimHead + (kSwimTail - kSwimHead) * std::pow(std::max(0.5 - at, 0.0), 2.0);
    return grown * std::sin(2 * kPi * at / kSwimWave + phase);
  };
  constexpr double kStep = 1e-4;
  return (side(z + kStep) - side(z - kStep)) / (2 * kStep);
}

// Headings of bones as turns of joints: each against the one above. Bones that point back are turned like the body.
void turnTo(const Skeleton& skeleton, std::span<const double> headings, Pose& pose) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    pose.locals[j].rotation = yaw(headings[j] - (parent ? headings[*parent] : 0));
  }
}

// The middle of each joint's bones, along z as it rests.
std::vector<double> middles(const Skeleton& skeleton) {
  std::vector<double> at, sums, bones(skeleton.joints.size(), 0);
  for (const Affine& global : restGlobals(skeleton)) at.push_back(global.translation().z());
  sums.assign(at.size(), 0);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (!parent || skeleton.joints[j].name.ends_with("Fin")) continue;
    sums[*parent] += 0.5 * (at[*parent] + at[j]);
    bones[*parent] += 1;
  }
  for (std::size_t j = 0; j < at.size(); ++j) {
    if (bones[j] > 0) at[j] = sums[j] / bones[j];
  }
  return at;
}

}  // namespace

Skeleton fishSkeleton() {
  return skeletonOf(kFish);
}
Skeleton serpentSkeleton() {
  return skeletonOf(kSerpent);
}
Skeleton birdSkeleton() {
  return skeletonOf(kBirdBones);
}

Pose swimAt(const Skeleton& fish, double seconds) {
  const double phase = 2 * kPi * seconds / kSwimSeconds;
  Pose pose = restPose(fish);
  std::vector<double> headings;
  for (const double z : middles(fish)) headings.push_back(std::atan(swimSlope(z, phase)));
  turnTo(fish, headings, pose);
  for (const char* name : {"leftFin", "rightFin"}) {
    const double side = name[0] == 'l' ? 1 : -1;
    pose.locals[fish.find(name).value()].rotation =
        Quat(Eigen::AngleAxisd(side * 0.25 * std::sin(phase), Vec3::UnitZ()));
  }
  pose.locals[0].translation.z() += kSwimMetres * seconds / kSwimSeconds;
  return pose;
}

Pose slitherAt(const Skeleton& serpent, double seconds) {
  // How far the body has come along its curve.
  const double gone = kSlitherWave * seconds / kSlitherSeconds;
  const auto heading = [](double along) { return kSlitherAngle * std::sin(2 * kPi * along / kSlitherWave); };
  Pose pose = restPose(serpent);
  std::vector<double> headings;
  for (const double z : middles(serpent)) headings.push_back(heading(z + gone));
  turnTo(serpent, headings, pose);
  constexpr int kSteps = 400;
  Vec3 position = Vec3::Zero();
  for (int i = 0; i < kSteps; ++i) {
    const double angle = heading(pose.locals[0].translation.z() + (i + 0.5) / kSteps * gone);
    position += gone / kSteps * Vec3(std::sin(angle), 0, std::cos(angle));
  }
  pose.locals[0].translation += position;
  return pose;
}

Pose flapAt(const Skeleton& bird, double seconds) {
  const double phase = 2 * kPi * seconds / kFlapSeconds;
  Pose pose = restPose(bird);
  const std::array<std::pair<const char*, double>, 3> bones = {
      {{"UpperWing", 0}, {"LowerWing", 0.8}, {"WingHand", 1.4}}};
  for (const auto& [bone, late] : bones) {
    const double angle = (late > 0 ? 0.5 : 1) * kFlap * std::cos(phase - late);
    for (const double side : {1.0, -1.0}) {
      const std::string name = (side > 0 ? "left" : "right") + std::string(bone);
      pose.locals[bird.find(name).value()].rotation = Quat(Eigen::AngleAxisd(side * angle, Vec3::UnitZ()));
    }
  }
  pose.locals[0].translation.y() -= kFlapBob * std::cos(phase - 0.5);
  return pose;
}

const double kSwimPeriod = kSwimSeconds, kSlitherPeriod = kSlitherSeconds, kFlapPeriod = kFlapSeconds;

}  // namespace limber
