// The sample motion "jumping-jack": apart with the arms up, and back.
#include <cmath>

#include "limber/core/numbers.h"
#include "limber/samples/motion_recipes.h"
#include "limber/samples/smooth_way.h"

namespace limber {

namespace {

constexpr double kSeconds = 1.2;                        // there and back
constexpr double kOff = 0.14, kLand = 0.36;             // shares of that, of the jump apart; half later together
constexpr double kTogether = 0.09, kApart = 0.32;       // metres, of a foot from the middle
constexpr double kPointed = -0.5, kFeetOutward = 0.12;  // radians

// 0 together, 1 apart.
double apartAt(double phase) {
  const double there = smoothRise((phase - kOff) / (kLand - kOff));
  return there - smoothRise((phase - kOff - 0.5) / (kLand - kOff));
}

// 0 at rest, 1 between, at each of the two jumps: `before` it and until `after` it.
double jumpBump(double phase, double before, double after) {
  const double way = kLand - kOff + before + after;
  return smoothBump((phase - kOff + before) / way) + smoothBump((phase - 0.5 - kOff + before) / way);
}

}  // namespace

Stance jumpingJackAt(double seconds) {
  const double strokes = seconds / kSeconds, phase = strokes - std::floor(strokes), apart = apartAt(phase);
  FootPlace foot;
  foot.outward = kFeetOutward;
  const Vec3 toes = turnedFoot(foot, kToToes);
  foot.pitch = kPointed * jumpBump(phase, 0.08, 0.08);
  foot.ankle = Vec3(kTogether + (kApart - kTogether) * apart, kAnkleHeight + 0.05 * jumpBump(phase, 0, 0), 0) + toes -
               turnedFoot(foot, kToToes);
  // Toes stay level while they are on the ground, and hang in the air.
  foot.toes = -foot.pitch * (1 - 0.6 * jumpBump(phase, 0, 0));
  const double raise = smoothRise((phase - 0.02) / 0.45) - smoothRise((phase - 0.52) / 0.45);
  const ArmPlace arm{0.15 + 2.6 * raise, 0.05, 0.25 - 0.05 * raise};

  Stance stance;
  stance.feet = {foot, foot};
  stance.arms = {arm, arm};
  // Bent before the jump and after it; legs that are apart reach less far down.
  const double bent =
      smoothBump((phase - 0.38) / 0.24) + smoothBump((phase + 0.12) / 0.24) + smoothBump((phase - 0.88) / 0.24);
  stance.pelvis = Vec3(0, 0.865 - 0.02 * apart - 0.045 * bent + 0.09 * jumpBump(phase, 0.06, 0.06), -0.02);
  stance.chest = Quat(Eigen::AngleAxisd(0.06 * bent, Vec3::UnitX()));
  return stance;
}

}  // namespace limber
