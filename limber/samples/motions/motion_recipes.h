// Sample motions as recipes: the figure's pose at each time. Walks and runs are gaits, tables of where and when feet
// are planted; all other motions pass through key poses.
#pragma once

#include <span>
#include <string>

#include "limber/samples/figure.h"

namespace limber {

// A bipedal gait. Fractions are of a stride (two steps), from a foot's touch; the right foot is half a stride behind
// the left.
struct BipedGait {
  double seconds;   // of a stride
  double stride;    // metres forward a stride
  double turn = 0;  // radians about +Y a stride

  // Each foot. The duty factor is the fraction that it is on the ground: above 0.5 both feet are at times, below it
  // none is, and the body flies. `flat` and `heelUp` are when the sole is flat down and when the heel leaves the
  // ground; `ahead` is how far before the body a foot comes down.
  double dutyFactor, flat, heelUp, ahead;
  double side, outward;                   // from the middle, metres; toes outwards, radians
  double touchPitch, offPitch, offSpeed;  // radians (toes up) at touch and at toe-off, and radians a stride then
  double lift, liftAt, swingPitch = 0;    // in the air: metres, when as a fraction of the swing, radians more

  double hipHeight, bob = 0;   // metres; the bob is of gaits that never fly
  double sway = 0, surge = 0;  // metres to the standing foot, and forward and back
  // Mean rotations, and how far they swing to and fro with the legs.
  BodyTurn hips = {}, hipsSwing = {}, chest = {}, chestSwing = {}, head = {}, headSwing = {};
  ArmPose arm = {}, armSwing = {};
};

extern const BipedGait kWalkGait, kRunGait, kSneakGait, kTurnGait;

Stance gaitAt(const BipedGait& gait, double seconds);

// The stance at a moment. From the first key that is `airborne` to the next that is not the body is in free fall, so
// the height of its pelvis between these is not used.
struct KeyPose {
  double seconds;
  Stance stance;
  bool airborne = false;
};

// Of a cycle of `period` seconds, keys in order from 0. What two keys after each other have in common does not move
// between them: toes that are planted stand still.
Stance keyedStance(std::span<const KeyPose> keys, double period, double seconds);

struct KeyedMotion {
  double period;  // seconds
  std::span<const KeyPose> (*keys)();
};

extern const KeyedMotion kJumpingJack, kJump, kIdle, kWave, kSitDown;

// With the names and about the proportions of the template quadruped, standing, facing +Z.
Skeleton quadrupedSkeleton();

// A quadrupedal gait; fractions are of a stride.
struct QuadrupedGait {
  double seconds, stride;                             // of a stride; metres
  double dutyFactor;                                  // the fraction that each leg is on the ground
  double leftHind, leftFront, rightHind, rightFront;  // when each leg touches
  double onGround;          // fraction of each bounce in which any leg is on the ground; 1 for a gait that never flies
  int bounces;              // of the body a stride
  double lift, sinks;       // metres: of a paw in the air; of the body below its rest pose where it leaves the ground
  double bob, sway, swing;  // metres, metres, radians to the side with the hind legs
  double rock, flex;        // radians: the trunk's pitch, and how far the back bends and stretches, once a stride
};

extern const QuadrupedGait kQuadrupedWalk, kTrot, kGallop;

// Where the toes of a leg are; how far its last bone leans forward over them, and they are turned against it, radians.
struct QuadrupedFoot {
  Vec3 toes = Vec3::Zero();  // metres
  double lean = 0, toesTurn = 0;
};

// The leg ("leftHind") of a body whose trunk is posed by `globals`; `rest` are the skeleton's own.
void placeQuadrupedLeg(const Skeleton& quadruped, const std::string& leg, const QuadrupedFoot& foot,
                       std::span<const Affine> rest, std::span<const Affine> globals, Pose& pose);

Pose quadrupedGaitAt(const QuadrupedGait& gait, const Skeleton& quadruped, double seconds);

// With the names and about the proportions of the templates fish, serpent and bird, facing +Z; one metre long, the bird
// with wings of two.
Skeleton fishSkeleton();
Skeleton serpentSkeleton();
Skeleton birdSkeleton();

// Likewise of the templates insect and spider, 0.7 metres long, and how they walk.
Skeleton insectSkeleton();
Skeleton spiderSkeleton();
Pose scuttleAt(const Skeleton& skeleton, double seconds);

extern const double kScuttlePeriod;                            // seconds
extern const double kSwimPeriod, kSlitherPeriod, kFlapPeriod;  // seconds
Pose swimAt(const Skeleton& fish, double seconds);
Pose slitherAt(const Skeleton& serpent, double seconds);
Pose flapAt(const Skeleton& bird, double seconds);

}  // namespace limber
