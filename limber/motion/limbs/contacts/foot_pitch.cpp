#include "limber/motion/limbs/contacts/foot_pitch.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"
#include "limber/motion/limbs/limb_reach.h"
#include "limber/motion/limbs/smooth.h"

namespace limber {

namespace {

struct Pitching {
  // Times the source's foot length, scaled; 1 to 2 (2 before); longer feet pitch less; by jerk on the shared pairs (at
  // most 1.1 times the source's on 526 of 528).
  double longFoot = 1.3;
  double flat = 0.1;  // radians; 0.05 to 0.2; pitch at which a flat foot is levelled by half; likewise
  // Cosine of the sole's slope; 0.3 to 0.5; from there on a foot pitches less wholly, at the opposite not at all; set
  // by hand.
  double steepest = 0.5;

  // Radians that a foot slopes down from its ankle, past the vertical; pi / 2 to pi, the first below the second;
  // between them its sole comes to look up. The third: 0.01 to 0.1; over which the tip is kept up. Set by hand.
  double steepTip = 2.5, upTip = 3, softTip = 0.02;
};
constexpr Pitching kPitching;

double lengthOf(const NeutralPose& neutral, Index ankle, Index toes) {
  return (neutral.restPositions[toes] - neutral.restPositions[ankle]).norm();
}

double angleOf(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// Of a foot whose ankle is at that height, in lengths of the foot, and whose tip is on the ground. Past the vertical it
// goes on, so that nothing snaps.
double slopeToGround(double height) {
  return straightenedAsin(height, kMaxExactSine);
}

}  // namespace

double footPitchFraction(const RetargetSetup& setup, const LegSpec& leg) {
  if (!leg.toes) return 1;
  const double source = setup.scale * lengthOf(setup.sourceNeutral, leg.sourceEnd, *leg.sourceToes);
  const double times = lengthOf(setup.targetNeutral, leg.end, *leg.toes) / (kPitching.longFoot * source);
  return source > 0 && times > 1 ? 1 / (times * times) : 1;
}

void limitFootPitch(const RetargetSetup& setup, const RootPositioner& root, std::span<const Leg> legs, Pose& target,
                    BodyFrame& frame) {
  const NeutralPose& neutral = setup.targetNeutral;
  for (const auto& [leg, state, goal] : legs) {
    const double standing = leg.plantigrade ? state.contact.flatness : 0;
    if (!leg.toes || (leg.footPitch == 1 && standing == 0)) continue;
    const Quat turn = frame.rotations[leg.end] * neutral.rotations[leg.end].conjugate();
    const Vec3 restDirection = (neutral.positions[*leg.toes] - neutral.positions[leg.end]).normalized();
    const Vec3 side = turn * Vec3::UnitX(), line = turn * restDirection;
    const Vec3 resting = Eigen::AngleAxisd(std::atan2(-side.z(), side.x()), Vec3::UnitY()) * restDirection;
    const double upright = std::hypot(side.x(), side.z()) * smoothStep(kPitching.steepest + (turn * Vec3::UnitY()).y());
    const double pitch = angleOf(line, resting),
                 flat = standing * kPitching.flat * kPitching.flat / (kPitching.flat * kPitching.flat + pitch * pitch);
    const double less = (1 - leg.footPitch * (1 - flat)) * upright;
    const Vec3 lowered = ((1 - less) * line + less * resting).normalized();
    const Quat limited = shortestRotation(line, lowered) * frame.rotations[leg.end];
    LimbReach(setup, root).turnEnd(leg.end, limited, frame, target);
  }
}

void keepTipUp(const RetargetSetup& setup, const RootPositioner& root, const LegSpec& leg, Pose& target,
               BodyFrame& frame) {
  const NeutralPose& neutral = setup.targetNeutral;
  const Vec3 ankle = frame.positions[leg.end], line = frame.positions[*leg.tip] - ankle;
  const Quat turn = frame.rotations[leg.end] * neutral.rotations[leg.end].conjugate();
  // Where the foot faces, also where it points straight down.
  const Vec3 restDirection = neutral.positions[*leg.tip] - neutral.positions[leg.end];
  const Vec3 ahead = alongGround(turn * (alongGround(restDirection).normalized() + Vec3::UnitY()));
  const double along = line.dot(ahead.normalized()), length = std::hypot(along, line.y());
  if (!(ahead.norm() > 1e-6) || !(length > 0)) return;
  const double slope = std::atan2(line.y(), along);
  const double fraction = std::clamp((kPitching.upTip + slope) / (kPitching.upTip - kPitching.steepTip), 0.0, 1.0);
  const double up =
      fraction * softPositive(-slopeToGround((ankle.y() - leg.toesGround) / length) - slope, kPitching.softTip);
  const Quat raised = Eigen::AngleAxisd(up, ahead.normalized().cross(Vec3::UnitY())) * frame.rotations[leg.end];
  LimbReach(setup, root).turnEnd(leg.end, raised, frame, target);
}

}  // namespace limber
