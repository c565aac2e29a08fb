// A body's position on the ground and its heading: what is left of its pose is the same anywhere.
#pragma once

#include "limber/motion/mix/mix_body.h"

namespace limber {

// In the person's space (BodyFrame): +Y is up. A point p of the body's own frame is at turn() * p + position().
struct GroundFrame {
  double x = 0, z = 0;  // metres
  double heading = 0;   // radians about +Y, against the neutral pose

  Quat turn() const { return Quat(Eigen::AngleAxisd(heading, Vec3::UnitY())); }
  Vec3 position() const { return {x, 0, z}; }
};

// The twist of a turn about +Y, radians within half a turn.
double turnAboutVertical(const Quat& turn);

// Below the pelvis, heading as that is turned about the vertical (the twist of its turn from the neutral pose). Not to
// be trusted of a body whose pelvis is upside down.
GroundFrame groundFrameOf(const MixBody& body, const BodyFrame& frame);

// A step from one such frame to another, seen from the first one: what moves on an arc at even speed and turn rate for
// one unit of time (the logarithm in SE(2)).
struct GroundStep {
  double x = 0, z = 0;  // metres
  double turn = 0;      // radians
};
GroundStep stepBetween(const GroundFrame& from, const GroundFrame& to);
GroundFrame moved(const GroundFrame& from, const GroundStep& step);
// 0 is a, 1 is b.
GroundStep mixOf(const GroundStep& a, const GroundStep& b, double weight);
// Linear between two positions, turned by the shorter rotation.
GroundFrame between(const GroundFrame& a, const GroundFrame& b, double weight);

// The pose as it is in the frame, and back out: its roots move.
void enterFrame(const MixBody& body, const GroundFrame& frame, Pose& pose);
void leaveFrame(const MixBody& body, const GroundFrame& frame, Pose& pose);

}  // namespace limber
