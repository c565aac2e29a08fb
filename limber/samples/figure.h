// The person that sample motions move, and its stance at a time.
#pragma once

#include <array>

#include "limber/skeleton/pose.h"

namespace limber {

// Radians: forward about +X, to the figure's left about +Y, about +Z; of a part of a body, in the order yaw, pitch,
// roll.
struct BodyTurn {
  double pitch = 0, yaw = 0, roll = 0;
};
Quat rotationOf(const BodyTurn& turn);

// Where a foot is: its sole turned about +Y (toes outwards) and its pitch (toes up), radians, and how far the toes are
// bent up against that.
struct FootPose {
  Vec3 ankle = Vec3::Zero();
  double outward = 0, pitch = 0, toes = 0;
};

// Radians: from hanging outwards (a right angle is a T-pose), then forward; the elbow's bend, and how far the bent
// forearm is rotated from forwards to upwards about an outstretched upper arm.
struct ArmPose {
  double raise = 0, swing = 0, elbow = 0, twist = 0;
};

// Both sides as on the left: x outwards.
struct Stance {
  Vec3 pelvis = Vec3::Zero();    // the middle between the upper legs' joints
  BodyTurn hips, chest, head;    // in the world
  std::array<FootPose, 2> feet;  // left, right
  std::array<ArmPose, 2> arms;
};

// 1.72 m tall, in T-pose, soles on y = 0, facing +Z; joints named as in VRM; all rest rotations are identities.
Skeleton figureSkeleton();

// From the ankle's joint of a flat foot: to the heel's end on the ground, and to the toes' joint.
inline const Vec3 kToHeel(0, -0.09, -0.05), kToToes(0, -0.065, 0.12);
inline constexpr double kAnkleHeight = 0.09;

// From an ankle to a point of its foot, `toPoint` of a flat one.
Vec3 turnedFoot(const FootPose& foot, const Vec3& toPoint);

// Legs reach their feet as far as they are long.
Pose poseOf(const Skeleton& figure, const Stance& stance);

}  // namespace limber
