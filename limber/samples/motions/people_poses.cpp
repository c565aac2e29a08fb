// Sample poses of a person. Angles in radians, positions in metres.
#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/pose_recipes.h"
#include "limber/samples/motions/stances.h"

namespace limber {

namespace {

constexpr double kHipWide = 0.10;  // of a foot from the middle, below its hip

FootPose movedForward(FootPose foot, double forward) {
  foot.ankle.z() += forward;
  return foot;
}

Stance standing() {
  return both({0, 0.885, 0}, planted(kHipWide));
}

}  // namespace

Stance standStance() {
  return standing();
}

// The left heel touches the ground.
Stance walkStance() {
  return gaitAt(kWalkGait, 0.02 * kWalkGait.seconds);
}

// The left foot has pushed off.
Stance runStance() {
  Stance stance = gaitAt(kRunGait, 0.36 * kRunGait.seconds);
  const double forward = stance.pelvis.z();
  stance.pelvis.z() = 0;
  for (FootPose& foot : stance.feet) foot.ankle.z() -= forward;
  return stance;
}

// On a seat as high as the knees.
Stance sitStance() {
  constexpr ArmPose kOnKnees{.raise = 0.14, .swing = 0.42, .elbow = 0.65};
  return leaning(both({0, 0.50, -0.39}, planted(kHipWide), kOnKnees), -0.10, 0.02, 0.02);
}

Stance crouchStance() {
  constexpr ArmPose kBeforeKnees{.raise = 0.25, .swing = 0.75, .elbow = 0.9};
  return leaning(both({0, 0.40, -0.17}, planted(0.14, -0.25), kBeforeKnees), 0.55, 0.75, 0.1);
}

// On the right knee.
Stance kneelStance() {
  Stance stance = standing();
  stance.pelvis = {0, 0.455, 0};
  stance.feet[0] = movedForward(planted(0.11), 0.40);
  stance.feet[1] = {{0.10, 0.15, -0.40}, 0, -1.25, 1.15};
  stance.arms[0] = {.raise = 0.2, .swing = 0.75, .elbow = 0.55};
  stance.chest.pitch = 0.08;
  return stance;
}

// The right hand for something high up in front, on tiptoe.
Stance reachStance() {
  Stance stance = both({-0.02, 0.93, 0.02}, planted(0.09, -0.55));
  stance.feet[0] = movedForward(stance.feet[0], -0.10);
  stance.feet[1] = movedForward(stance.feet[1], 0.02);
  stance.arms[1] = {.raise = 0.1, .swing = 2.65, .elbow = 0.12};
  stance.chest = {-0.04, 0.14, 0.12};
  stance.hips.roll = 0.06;
  stance.head = {-0.40, -0.10, 0.02};
  return stance;
}

Stance pointStance() {
  Stance stance = standing();
  stance.feet[0] = movedForward(planted(kHipWide), 0.12);
  stance.feet[1] = movedForward(planted(kHipWide), -0.10);
  stance.arms[1] = {.raise = 0.12, .swing = 1.5, .elbow = 0.04};
  stance.chest = {0.03, 0.18, 0};
  stance.head = {0.0, -0.05, 0};
  return stance;
}

Stance waveStance() {
  Stance stance = both({-0.015, 0.88, 0}, planted(kHipWide));
  stance.arms[1] = {.raise = 1.54, .swing = 0.35, .elbow = 1.6, .twist = 1.5};
  stance.hips.roll = -0.03;
  stance.chest = {0.02, -0.10, 0.05};
  stance.head = {-0.03, -0.12, -0.08};
  return stance;
}

// Both hands up.
Stance cheerStance() {
  constexpr ArmPose kUp{.raise = 2.55, .swing = 0.1, .elbow = 0.3};
  return leaning(both({0, 0.88, 0}, planted(0.16), kUp), 0, -0.10, -0.25);
}

// At the top of a jump.
Stance jumpStance() {
  constexpr ArmPose kThrown{.raise = 0.35, .swing = 2.6, .elbow = 0.3};
  Stance stance = both({0, 1.06, 0}, lifted(0.11, 0.21, -0.7), kThrown);
  stance.feet[1] = movedForward(lifted(0.11, 0.46, -0.9), -0.25);
  return leaning(stance, 0.05, 0.02, -0.15);
}

// Hands on the thighs.
Stance bowStance() {
  constexpr ArmPose kForward{.raise = 0.12, .swing = 0.55, .elbow = 0.15};
  return leaning(both({0, 0.85, -0.12}, planted(0.08), kForward), 0.75, 1.05, 0.95);
}

}  // namespace limber
