// The sample motion "walk". Proportions of time and the body's sways after measured gait (Perry 1992; Winter 1991): a
// foot stands for 62 % of a stride, first on the heel, then flat, then on the toes.
#include <algorithm>
#include <cmath>

#include "limber/core/numbers.h"
#include "limber/samples/motion_recipes.h"
#include "limber/samples/smooth_way.h"

namespace limber {

namespace {

constexpr double kStride = 1.2, kStrideSeconds = 1.1;  // of two steps, metres
// Shares of a stride, from the heel's touch.
constexpr double kFlat = 0.10, kHeelUp = 0.38, kToeOff = 0.62;
constexpr double kAhead = 0.25;  // of a stride: how far before the pelvis a foot comes down
// Radians; the pitch's speed is per stride.
constexpr double kTouchPitch = 0.38, kOffPitch = -0.95, kOffSpeed = -4.5, kOutward = 0.09;
constexpr double kFootSide = 0.065, kLift = 0.045;  // metres
constexpr double kHipHeight = 0.855;

double cosineWave(double phase) {
  return std::cos(2 * kPi * phase);
}

double stancePitch(double phase) {
  if (phase < kFlat) return kTouchPitch * (1 - smoothRise(phase / kFlat));
  if (phase < kHeelUp) return 0;
  // Backwards in time, from how the foot leaves the ground to where it rests.
  const double way = kToeOff - kHeelUp;
  return smoothWay(kOffPitch, -kOffSpeed * way, 0.0, 0.0, (kToeOff - phase) / way);
}

// A foot on the ground; `flat` is where its ankle is when it stands flat.
FootPlace standing(double phase, const Vec3& flat) {
  FootPlace foot{flat, kOutward, stancePitch(phase), 0};
  const Vec3& pivot = phase < kFlat ? kToHeel : kToToes;
  FootPlace level = foot;
  level.pitch = 0;
  foot.ankle += turnedFoot(level, pivot) - turnedFoot(foot, pivot);
  if (phase > kHeelUp) foot.toes = -foot.pitch;
  return foot;
}

FootPlace swinging(double phase, const Vec3& from, const Vec3& to) {
  const FootPlace off = standing(kToeOff, from), touch = standing(0, to);
  const double way = 1 - kToeOff, share = (phase - kToeOff) / way;
  // The toes are the pivot until they leave the ground, so that the ankle is on a circle about them.
  const Vec3 axis = Eigen::AngleAxisd(kOutward, Vec3::UnitY()) * -Vec3::UnitX(), arm = -turnedFoot(off, kToToes);
  const Vec3 speed = kOffSpeed * way * axis.cross(arm);
  const Vec3 acceleration = kOffSpeed * way * axis.cross(speed);
  FootPlace foot;
  foot.ankle = smoothWay(off.ankle, speed, acceleration, touch.ankle, share);
  foot.ankle.y() += kLift * smoothBump(share);
  foot.outward = kOutward;
  foot.pitch = smoothWay(kOffPitch, kOffSpeed * way, 0.0, kTouchPitch, share);
  foot.toes = smoothWay(-kOffPitch, -kOffSpeed * way, 0.0, 0.0, std::min(1.0, 1.2 * share));
  return foot;
}

FootPlace footAt(double strides) {
  const double touched = std::floor(strides), phase = strides - touched;
  const auto place = [](double count) { return Vec3(kFootSide, kAnkleHeight, (count + kAhead) * kStride); };
  return phase < kToeOff ? standing(phase, place(touched)) : swinging(phase, place(touched), place(touched + 1));
}

Quat turned(double pitch, double yaw, double roll) {
  return Quat(Eigen::AngleAxisd(yaw, Vec3::UnitY()) * Eigen::AngleAxisd(pitch, Vec3::UnitX()) *
              Eigen::AngleAxisd(roll, Vec3::UnitZ()));
}

ArmPlace armAt(double strides) {
  const double forward = -cosineWave(strides);  // against the leg of its side
  return {0.14, -0.04 + 0.36 * forward, 0.30 + 0.16 * forward};
}

}  // namespace

Stance walkAt(double seconds) {
  // Of the left foot; the right is half a stride behind.
  const double left = seconds / kStrideSeconds, right = left + 0.5;
  Stance stance;
  stance.feet = {footAt(left), footAt(right)};
  stance.feet[1].ankle.z() -= 0.5 * kStride;
  stance.arms = {armAt(left), armAt(right)};
  // Highest over the standing foot and towards it, slowest there; the side that swings goes ahead and is lower.
  stance.pelvis = Vec3(0.022 * cosineWave(left - 0.3), kHipHeight - 0.018 * cosineWave(2 * (left - 0.05)),
                       kStride * left + 0.012 * std::sin(4 * kPi * (left - 0.05)));
  stance.hips = turned(0.05, -0.10 * cosineWave(left), 0.06 * cosineWave(left - 0.22));
  stance.chest = turned(0.04, 0.09 * cosineWave(left), -0.02 * cosineWave(left - 0.22));
  stance.head = turned(0.02, 0.02 * cosineWave(left), 0);
  return stance;
}

}  // namespace limber
