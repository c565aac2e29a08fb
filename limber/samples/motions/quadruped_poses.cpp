// Sample poses of an animal on four legs. Angles in radians, positions in metres.
#include <string>

#include "limber/samples/motions/motion_recipes.h"
#include "limber/samples/motions/pose_recipes.h"

namespace limber {

namespace {

// Of both feet of a pair, from where the toes rest.
struct PawPose {
  double outward = 0, forward = 0;
  double lean = 0;  // QuadrupedFoot
};

// How the trunk's joints are turned against their parents, nose down, and where the paws are; both sides are the same.
struct QuadrupedStance {
  double lowered = 0, forward = 0;  // of the hips
  double hips = 0, back = 0, chest = 0, neck = 0, head = 0;
  double tail = 0, tailTip = 0;
  PawPose front, hind;
};

void pitchJoint(const Skeleton& quadruped, const char* name, double angle, Pose& pose) {
  pose.locals[quadruped.find(name).value()].rotation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitX()));
}

void placePaws(const Skeleton& quadruped, const QuadrupedStance& stance, Pose& pose) {
  const std::vector<Affine> rest = restGlobals(quadruped), globals = poseGlobals(quadruped, pose);
  for (const char* leg : {"leftHind", "rightHind", "leftFront", "rightFront"}) {
    const std::string name = leg;
    const PawPose& paw = name.ends_with("Front") ? stance.front : stance.hind;
    const double side = name.starts_with("left") ? 1 : -1;
    const Vec3 toes = rest[quadruped.find(name + "Toes").value()].translation();
    placeQuadrupedLeg(quadruped, name, {toes + Vec3(side * paw.outward, 0, paw.forward), paw.lean, -paw.lean}, rest,
                      globals, pose);
  }
}

Pose quadrupedPose(const Skeleton& quadruped, const QuadrupedStance& stance) {
  Pose pose = restPose(quadruped);
  pose.locals[0].translation += Vec3(0, -stance.lowered, stance.forward);
  pitchJoint(quadruped, "hips", stance.hips, pose);
  pitchJoint(quadruped, "spine", stance.back / 2, pose);
  pitchJoint(quadruped, "spine1", stance.back / 2, pose);
  pitchJoint(quadruped, "chest", stance.chest, pose);
  pitchJoint(quadruped, "neck", stance.neck / 2, pose);
  pitchJoint(quadruped, "neck1", stance.neck / 2, pose);
  pitchJoint(quadruped, "head", stance.head, pose);
  pitchJoint(quadruped, "tail", stance.tail, pose);
  pitchJoint(quadruped, "tail1", stance.tailTip / 2, pose);
  pitchJoint(quadruped, "tail2", stance.tailTip / 2, pose);
  placePaws(quadruped, stance, pose);
  return pose;
}

// On its haunches, the hind feet flat on the ground.
constexpr QuadrupedStance kSitting = {.lowered = 0.235,
                                      .forward = 0.045,
                                      .hips = -0.78,
                                      .back = 0.15,
                                      .chest = 0.1,
                                      .neck = 0.45,
                                      .head = 0.15,
                                      .tail = 0.75,
                                      .tailTip = 0.3,
                                      .front = {.outward = -0.01, .forward = -0.01},
                                      .hind = {.outward = 0.03, .forward = 0.13, .lean = -1.15}};

}  // namespace

Pose quadrupedStand(const Skeleton& quadruped) {
  return restPose(quadruped);
}

Pose quadrupedWalk(const Skeleton& quadruped) {
  return quadrupedGaitAt(kQuadrupedWalk, quadruped, 0.16 * kQuadrupedWalk.seconds);
}

Pose quadrupedSit(const Skeleton& quadruped) {
  return quadrupedPose(quadruped, kSitting);
}

// On its belly, the forelegs out in front.
Pose quadrupedLie(const Skeleton& quadruped) {
  return quadrupedPose(quadruped, {.lowered = 0.225,
                                   .hips = 0.02,
                                   .neck = 0.05,
                                   .head = 0.0,
                                   .tail = 0.35,
                                   .tailTip = 0.2,
                                   .front = {.forward = 0.21},
                                   .hind = {.outward = 0.05, .forward = 0.10, .lean = -1.25}});
}

// The chest low over the forelegs, the rump up: it stretches, or wants to play.
Pose quadrupedStretch(const Skeleton& quadruped) {
  return quadrupedPose(quadruped, {.lowered = 0.0,
                                   .forward = -0.06,
                                   .hips = 0.50,
                                   .back = 0.05,
                                   .chest = -0.1,
                                   .neck = -0.35,
                                   .head = -0.25,
                                   .tail = -1.0,
                                   .tailTip = -0.4,
                                   .front = {.forward = 0.13},
                                   .hind = {.outward = 0.01}});
}

Pose quadrupedHowl(const Skeleton& quadruped) {
  QuadrupedStance stance = kSitting;
  stance.neck = -0.1;
  stance.head = -0.75;
  return quadrupedPose(quadruped, stance);
}

}  // namespace limber
