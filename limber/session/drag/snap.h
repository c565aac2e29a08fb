// Round numbers for a hand that is not exact: steps that rotations and positions snap to.
#pragma once

#include <optional>

#include "limber/core/transform.h"

namespace limber {

struct RiggedModel;

// What a drag of one joint snaps to.
struct DragSnap {
  double degrees = 15;           // rotations go in steps of this, from the joint's initial rotation
  double step = 0.01;            // metres between the points of a grid through the world's origin
  Vec3 up = Vec3::UnitY();       // of the world
  std::optional<double> ground;  // metres along `up`: a foot there is on the floor
};

// The nearest of 1, 2 and 5 times a power of ten, as the logarithm measures; 1 where `length` is not above 0.
double roundStep(double length);

// For that joint of the model: the grid has about a hundred steps along the model, and a foot is on the floor at its
// height in the rest pose.
DragSnap snapOf(const RiggedModel& rig, Index joint);

// The nearest point of the grid; within a step of the floor, its height is the floor's. World space.
Vec3 snapPosition(const DragSnap& snap, const Vec3& position);
// The same axis, by the nearest number of steps.
Quat snapTurn(const DragSnap& snap, const Quat& turn);
// The nearest tenth above 0.
double snapScale(double scale);

}  // namespace limber
