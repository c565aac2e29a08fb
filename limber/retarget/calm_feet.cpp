#include "limber/retarget/calm_feet.h"

#include <algorithm>
#include <cmath>

#include "limber/ik/rotation.h"
#include "limber/retarget/limb_reach.h"
#include "limber/retarget/smooth.h"

namespace limber {

namespace {

constexpr double kLong = 1.3;      // times the source's length, scaled: from there on
constexpr double kFlat = 0.1;      // radians of pitch by which a foot that stands flat still lies half down
constexpr double kSteepest = 0.5;  // that counts wholly, as the cosine of the sole's slope; not at all at its opposite

double lengthOf(const NeutralPose& neutral, Index ankle, Index toes) {
  return (neutral.restPositions[toes] - neutral.restPositions[ankle]).norm();
}

double angleOf(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

double footPitchShare(const RetargetSetup& setup, const Leg& leg) {
  if (!leg.toes) return 1;
  const double source = setup.scale * lengthOf(setup.sourceNeutral, leg.sourceEnd, *leg.sourceToes);
  const double times = lengthOf(setup.targetNeutral, leg.end, *leg.toes) / (kLong * source);
  return source > 0 && times > 1 ? 1 / (times * times) : 1;
}

void calmFeet(const RetargetSetup& setup, const RootPlacer& root, std::span<const Leg> legs, Pose& target,
              BodyFrame& frame) {
  const NeutralPose& neutral = setup.targetNeutral;
  for (const Leg& leg : legs) {
    const double standing = setup.person ? leg.flatness : 0;
    if (!leg.toes || (leg.footPitch == 1 && standing == 0)) continue;
    const Quat turn = frame.rotations[leg.end] * neutral.rotations[leg.end].conjugate();
    const Vec3 stands = (neutral.positions[*leg.toes] - neutral.positions[leg.end]).normalized();
    const Vec3 side = turn * Vec3::UnitX(), line = turn * stands;
    const Vec3 level = Eigen::AngleAxisd(std::atan2(-side.z(), side.x()), Vec3::UnitY()) * stands;
    const double upright = std::hypot(side.x(), side.z()) * smoothStep(kSteepest + (turn * Vec3::UnitY()).y());
    const double pitch = angleOf(line, level), flat = standing * kFlat * kFlat / (kFlat * kFlat + pitch * pitch);
    const double less = (1 - leg.footPitch * (1 - flat)) * upright;
    const Vec3 wanted = ((1 - less) * line + less * level).normalized();
    const Quat calmed = shortestRotation(line, wanted) * frame.rotations[leg.end];
    LimbReach(setup, root).turnEnd(leg, calmed, frame, target);
  }
}

}  // namespace limber
