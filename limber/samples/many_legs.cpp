// Walks on six and on eight legs, for skeletons of the templates insect and spider. Legs next to each other, and the
// two of a pair, alternate: an insect is always on three (the tripod gait), a spider on four (Wilson: Insect
// walking, 1966; Spider locomotion on level ground: Biancardi and others, 2011).
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/smooth_path.h"
#include "limber/skeleton/ik/solvers/two_bone.h"
#include "limber/skeleton/placed_skeleton.h"

namespace limber {

namespace {

constexpr double kSeconds = 0.6, kStride = 0.16;  // of a stride, metres
constexpr double kDutyFactor = 0.6;               // the fraction of a stride that a leg is on the ground
constexpr double kLift = 0.06, kBob = 0.004;      // metres, of a foot in the air and of the body twice a stride
constexpr double kTail = 0.04;                    // radians, of the tail to each side

std::string legName(const char* bone, int pair, bool left) {
  return (left ? "left" : "right") + std::string(bone) + (pair > 0 ? std::to_string(pair) : "");
}

// Where the limb's joints rest: the foot's tip last.
struct LegPositions {
  Vec3 upper, lower, foot, tip;
};
LegPositions legAt(int pair, int pairs) {
  const double along = 0.5 - static_cast<double>(pair) / (pairs - 1);  // from 0.5 to -0.5
  const double z = 0.2 * along, fan = 0.5 * along;
  return {{0.06, 0.18, z}, {0.2, 0.3, z + 0.3 * fan}, {0.36, 0.14, z + 0.8 * fan}, {0.42, 0.01, z + fan}};
}

// How far a foot is behind its touchdown as a fraction of its path: in stance from 0 to 1, in swing back to 0.
double footDisplacement(double phase) {
  if (phase < kDutyFactor) return phase / kDutyFactor;
  return 1 - smoothRise((phase - kDutyFactor) / (1 - kDutyFactor));
}

Skeleton manyLegged(int pairs) {
  PlacedSkeleton skeleton;
  skeleton.add("hips", "", {0, 0.18, -0.1});
  skeleton.add("spine", "hips", {0, 0.18, 0});
  skeleton.add("chest", "spine", {0, 0.18, 0.1});
  skeleton.add("neck", "chest", {0, 0.18, 0.16});
  skeleton.add("head", "neck", {0, 0.18, 0.2});
  skeleton.add("head_end", "head", {0, 0.17, 0.28});
  skeleton.add("tail", "hips", {0, 0.19, -0.2});
  skeleton.add("tail1", "tail", {0, 0.2, -0.3});
  skeleton.add("tail2", "tail1", {0, 0.2, -0.4});
  for (int pair = 0; pair < pairs; ++pair) {
    const LegPositions leg = legAt(pair, pairs);
    const std::string carrier = 2 * pair < pairs ? "chest" : "hips";
    for (const bool left : {true, false}) {
      const auto sided = [&](const Vec3& position) {
        return Vec3(left ? position.x() : -position.x(), position.y(), position.z());
      };
      const std::string upper = legName("UpperLeg", pair, left), lower = legName("LowerLeg", pair, left),
                        foot = legName("Foot", pair, left);
      skeleton.add(upper, carrier, sided(leg.upper));
      skeleton.add(lower, upper, sided(leg.lower));
      skeleton.add(foot, lower, sided(leg.foot));
      skeleton.add(foot + "_end", foot, sided(leg.tip));
    }
  }
  return skeleton.take();
}

// The foot's bone has its rest rotation, the two above it reach for its root.
void placeLeg(const Skeleton& skeleton, int pair, bool left, const Vec3& tip, std::span<const Affine> rest,
              std::span<const Affine> globals, Pose& pose) {
  const Index upper = skeleton.find(legName("UpperLeg", pair, left)).value(), lower = upper + 1, foot = upper + 2,
              end = upper + 3;
  TwoBone bones;
  bones.start = globals[upper].translation();
  bones.middle = globals[lower].translation();
  bones.end = globals[foot].translation();
  bones.target = tip - (rest[end].translation() - rest[foot].translation());
  bones.pole = 0.5 * (bones.start + bones.target) + Vec3(0, 1, 0);
  const TwoBoneTurns turns = solveTwoBone(bones);
  const Quat above(globals[*skeleton.joints[upper].parent].linear()), body(globals[upper].linear());
  const Quat upperTurn = turns.start * body, lowerTurn = turns.middle * body;
  pose.locals[upper].rotation = above.conjugate() * upperTurn;
  pose.locals[lower].rotation = upperTurn.conjugate() * lowerTurn;
  pose.locals[foot].rotation = lowerTurn.conjugate();
}

}  // namespace

const double kScuttlePeriod = kSeconds;

Skeleton insectSkeleton() {
  return manyLegged(3);
}
Skeleton spiderSkeleton() {
  return manyLegged(4);
}

Pose scuttleAt(const Skeleton& skeleton, double seconds) {
  const int pairs = skeleton.find("leftFoot3") ? 4 : 3;
  const double strides = seconds / kSeconds;
  Pose pose = restPose(skeleton);
  pose.locals[0].translation += Vec3(0, kBob * std::sin(4 * kPi * strides), kStride * strides);
  const std::string tails[] = {"tail", "tail1"};
  for (const std::string& tail : tails) {
    pose.locals[skeleton.find(tail).value()].rotation =
        Quat(Eigen::AngleAxisd(kTail * std::sin(2 * kPi * strides), Vec3::UnitY()));
  }
  const std::vector<Affine> rest = restGlobals(skeleton), globals = poseGlobals(skeleton, pose);
  for (int pair = 0; pair < pairs; ++pair) {
    for (const bool left : {true, false}) {
      const double behind = (pair % 2 == 0) == left ? 0 : 0.5, own = strides - behind, phase = own - std::floor(own);
      const double swing = (phase - kDutyFactor) / (1 - kDutyFactor);  // below 0 in stance
      // Ahead of its rest position by half its path in stance, then back as far, as the body goes on.
      const double pathLength = kDutyFactor * kStride * (0.5 - footDisplacement(phase));
      const Index end = skeleton.find(legName("Foot", pair, left)).value() + 1;
      const Vec3 tip = rest[end].translation() + Vec3(0, kLift * smoothBump(swing), kStride * strides + pathLength);
      placeLeg(skeleton, pair, left, tip, rest, globals, pose);
    }
  }
  return pose;
}

}  // namespace limber
