// Gaits of the sample person. Of the walk, fractions of a stride and the body's sways are after measured gait (Perry
// 1992; Winter 1991): a foot is in stance for 62 % of a stride, first on the heel, then flat, then on the toes. Duty
// factors: 0.6 and more in a walk, 0.35 in a run (Alexander, Principles of Animal Locomotion, 2003).
#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/smooth_path.h"

namespace limber {

const BipedGait kWalkGait = {.seconds = 1.1,
                             .stride = 1.2,
                             .dutyFactor = 0.62,
                             .flat = 0.10,
                             .heelUp = 0.38,
                             .ahead = 0.25,
                             .side = 0.065,
                             .outward = 0.09,
                             .touchPitch = 0.38,
                             .offPitch = -0.95,
                             .offSpeed = -4.5,
                             .lift = 0.045,
                             .liftAt = 0.5,
                             .hipHeight = 0.855,
                             .bob = 0.018,
                             .sway = 0.022,
                             .surge = 0.012,
                             .hips = {.pitch = 0.05},
                             .hipsSwing = {.yaw = -0.10, .roll = 0.06},
                             .chest = {.pitch = 0.04},
                             .chestSwing = {.yaw = 0.09, .roll = -0.02},
                             .head = {.pitch = 0.02},
                             .headSwing = {.yaw = 0.02},
                             .arm = {.raise = 0.14, .swing = -0.04, .elbow = 0.30},
                             .armSwing = {.swing = 0.36, .elbow = 0.16}};

// 2.7 m/s. The feet come down nearly flat and under the body, and are kicked up behind it.
const BipedGait kRunGait = {.seconds = 0.7,
                            .stride = 1.9,
                            .dutyFactor = 0.35,
                            .flat = 0.05,
                            .heelUp = 0.16,
                            .ahead = 0.13,
                            .side = 0.05,
                            .outward = 0.06,
                            .touchPitch = 0.12,
                            .offPitch = -1.1,
                            .offSpeed = -6.5,
                            .lift = 0.36,
                            .liftAt = 0.4,
                            .swingPitch = -0.75,
                            .hipHeight = 0.815,
                            .sway = 0.008,
                            .hips = {.pitch = 0.14},
                            .hipsSwing = {.yaw = -0.16, .roll = 0.05},
                            .chest = {.pitch = 0.20},
                            .chestSwing = {.yaw = 0.20, .roll = -0.02},
                            .head = {.pitch = 0.06},
                            .headSwing = {.yaw = 0.03},
                            .arm = {.raise = 0.22, .swing = -0.15, .elbow = 1.55},
                            .armSwing = {.swing = 0.75, .elbow = 0.15}};

// Low and slow, on the balls of the feet, which are lifted high; the head looks out to both sides.
const BipedGait kSneakGait = {.seconds = 1.8,
                              .stride = 0.8,
                              .dutyFactor = 0.66,
                              .flat = 0.16,
                              .heelUp = 0.44,
                              .ahead = 0.31,
                              .side = 0.08,
                              .outward = 0.14,
                              .touchPitch = -0.45,
                              .offPitch = -0.75,
                              .offSpeed = -3.0,
                              .lift = 0.17,
                              .liftAt = 0.5,
                              .swingPitch = -0.1,
                              .hipHeight = 0.70,
                              .bob = 0.025,
                              .sway = 0.035,
                              .surge = 0.02,
                              .hips = {.pitch = 0.40},
                              .hipsSwing = {.yaw = -0.08, .roll = 0.05},
                              .chest = {.pitch = 0.72},
                              .chestSwing = {.yaw = 0.08, .roll = 0.04},
                              .head = {.pitch = 0.12},
                              .headSwing = {.yaw = 0.35},
                              .arm = {.raise = 0.28, .swing = 0.42, .elbow = 1.75},
                              .armSwing = {.swing = 0.30, .elbow = 0.15}};

// A quarter turn a stride, on the spot; the head goes first.
const BipedGait kTurnGait = {.seconds = 1.0,
                             .stride = 0,
                             .turn = kPi / 2,
                             .dutyFactor = 0.66,
                             .flat = 0.10,
                             .heelUp = 0.52,
                             .ahead = 0.33,
                             .side = 0.12,
                             .outward = 0.10,
                             .touchPitch = -0.12,
                             .offPitch = -0.40,
                             .offSpeed = -3.0,
                             .lift = 0.07,
                             .liftAt = 0.5,
                             .hipHeight = 0.855,
                             .bob = 0.012,
                             .sway = 0.03,
                             .hips = {.pitch = 0.03},
                             .hipsSwing = {.roll = 0.04},
                             .chest = {.pitch = 0.03, .yaw = 0.12},
                             .chestSwing = {.roll = -0.02},
                             .head = {.pitch = 0.03, .yaw = 0.38},
                             .arm = {.raise = 0.20, .swing = 0.0, .elbow = 0.35},
                             .armSwing = {.swing = 0.14, .elbow = 0.08}};

namespace {

double cosineWave(double phase) {
  return std::cos(2 * kPi * phase);
}

// One foot of a gait; `mirrored` on the right, where the gait's turn is negated.
class Foot {
 public:
  Foot(const BipedGait& gait, bool mirrored)
      : gait_(gait), turn_(mirrored ? -gait.turn : gait.turn), behind_(mirrored ? 0.5 : 0.0) {}

  FootPose at(double bodyStrides) const {
    const double strides = bodyStrides + behind_, count = std::floor(strides), phase = strides - count;
    return phase < gait_.dutyFactor ? standing(phase, count) : swinging(phase, count);
  }

 private:
  // On the ground since it touched for the `count`th time.
  FootPose standing(double phase, double count) const {
    const double along = count + gait_.ahead - behind_, heading = turn_ * along;
    FootPose foot;
    foot.ankle = Eigen::AngleAxisd(heading, Vec3::UnitY()) * Vec3(gait_.side, kAnkleHeight, 0);
    foot.ankle.z() += gait_.stride * along;
    foot.outward = gait_.outward + heading;
    foot.pitch = stancePitch(phase);
    FootPose level = foot;
    level.pitch = 0;
    const Vec3& pivot = foot.pitch > 0 ? kToHeel : kToToes;
    foot.ankle += turnedFoot(level, pivot) - turnedFoot(foot, pivot);
    foot.toes = std::max(0.0, -foot.pitch);
    return foot;
  }

  double stancePitch(double phase) const {
    if (phase < gait_.flat) return gait_.touchPitch * (1 - smoothRise(phase / gait_.flat));
    if (phase < gait_.heelUp) return 0;
    // Backwards in time, from how the foot leaves the ground to where it rests.
    const double duration = gait_.dutyFactor - gait_.heelUp;
    return smoothPath(gait_.offPitch, -gait_.offSpeed * duration, 0.0, 0.0, (gait_.dutyFactor - phase) / duration);
  }

  FootPose swinging(double phase, double count) const {
    const FootPose off = standing(gait_.dutyFactor, count), touch = standing(0, count + 1);
    const double duration = 1 - gait_.dutyFactor, fraction = (phase - gait_.dutyFactor) / duration,
                 speed = gait_.offSpeed * duration;
    // The toes are the pivot until they leave the ground, so that the ankle is on a circle about them.
    const Vec3 axis = Eigen::AngleAxisd(off.outward, Vec3::UnitY()) * -Vec3::UnitX(), arm = -turnedFoot(off, kToToes);
    const Vec3 ankleSpeed = speed * axis.cross(arm), ankleAcceleration = speed * axis.cross(ankleSpeed);
    // The bump's middle, 0.5, is when the foot is highest.
    const double bump = smoothBump(std::pow(fraction, std::log(0.5) / std::log(gait_.liftAt)));
    FootPose foot;
    foot.ankle = smoothPath(off.ankle, ankleSpeed, ankleAcceleration, touch.ankle, fraction);
    foot.ankle.y() += gait_.lift * bump;
    foot.outward = off.outward + (touch.outward - off.outward) * smoothRise(fraction);
    foot.pitch = smoothPath(gait_.offPitch, speed, 0.0, gait_.touchPitch, fraction) + gait_.swingPitch * bump;
    foot.toes = smoothPath(-gait_.offPitch, -speed, 0.0, touch.toes, std::min(1.0, 1.2 * fraction));
    return foot;
  }

  const BipedGait& gait_;
  double turn_, behind_;
};

ArmPose armAt(const BipedGait& gait, double strides) {
  const double forward = -cosineWave(strides);  // against the leg of its side
  return {gait.arm.raise, gait.arm.swing + gait.armSwing.swing * forward,
          gait.arm.elbow + gait.armSwing.elbow * forward};
}

// Highest over the foot in stance where one always is, else in the middle of the flight.
double pelvisHeight(const BipedGait& gait, double strides) {
  if (gait.dutyFactor > 0.5) return gait.hipHeight - gait.bob * cosineWave(2 * (strides - 0.05));
  const double steps = 2 * strides;
  return gait.hipHeight + bounceHeight(steps - std::floor(steps), 2 * gait.dutyFactor, 0.5 * gait.seconds);
}

// Yaw goes with the legs; roll is late by `late`: the side whose foot swings is lower.
BodyTurn swung(const BodyTurn& bodyTurn, const BodyTurn& swing, double strides, double heading) {
  constexpr double kLate = 0.22;
  return {bodyTurn.pitch, bodyTurn.yaw + heading + swing.yaw * cosineWave(strides),
          bodyTurn.roll + swing.roll * cosineWave(strides - kLate)};
}

}  // namespace

Stance gaitAt(const BipedGait& gait, double seconds) {
  const double strides = seconds / gait.seconds, heading = gait.turn * strides;
  Stance stance;
  stance.feet = {Foot(gait, false).at(strides), Foot(gait, true).at(strides)};
  stance.arms = {armAt(gait, strides), armAt(gait, strides + 0.5)};
  // Towards the standing foot, and slowest over it.
  const Vec3 offset(gait.sway * cosineWave(strides - 0.3), pelvisHeight(gait, strides),
                    gait.surge * std::sin(4 * kPi * (strides - 0.05)));
  stance.pelvis = Eigen::AngleAxisd(heading, Vec3::UnitY()) * offset;
  stance.pelvis.z() += gait.stride * strides;
  stance.hips = swung(gait.hips, gait.hipsSwing, strides, heading);
  stance.chest = swung(gait.chest, gait.chestSwing, strides, heading);
  stance.head = swung(gait.head, gait.headSwing, strides, heading);
  return stance;
}

}  // namespace limber
