#include "limber/motion/mix/ground_frame.h"

#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr double kStraight = 1e-8;  // radians; 1e-12 to 1e-6; a step that turns by less is straight; rounding only

double wrapped(double angle) {
  return angle - 2 * kPi * std::round(angle / (2 * kPi));
}

// Roots turned, then moved, both in the person's space.
void moveRoots(const MixBody& body, const Quat& turn, const Vec3& shift, Pose& pose) {
  const Quat toBody = body.setup().targetKinematics.toBody();
  const Quat turn_model = toBody.conjugate() * turn * toBody;
  const Vec3 shift_model = toBody.conjugate() * shift;
  const Skeleton& skeleton = body.plain().skeleton();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent) continue;
    Transform& local = pose.locals[j];
    local.translation = turn_model * local.translation + shift_model;
    local.rotation = turn_model * local.rotation;
  }
}

}  // namespace

double turnAboutVertical(const Quat& turn) {
  return wrapped(2 * std::atan2(turn.y(), turn.w()));
}

GroundFrame groundFrameOf(const MixBody& body, const BodyFrame& frame) {
  const NeutralPose& neutral = body.setup().targetNeutral;
  const Vec3 position = pelvisOf(body.setup().map, MapSide::kTarget, frame.positions);
  const Quat turn = frame.rotations[body.pelvis()] * neutral.rotations[body.pelvis()].conjugate();
  return {position.x(), position.z(), turnAboutVertical(turn)};
}

GroundStep stepBetween(const GroundFrame& from, const GroundFrame& to) {
  const Vec3 displacement = from.turn().conjugate() * (to.position() - from.position());
  const double turn = wrapped(to.heading - from.heading), half = turn / 2;
  if (std::abs(turn) < kStraight) return {displacement.x(), displacement.z(), turn};
  // The chord of the arc, back to its tangent.
  const Vec3 along = half / std::sin(half) * (Eigen::AngleAxisd(-half, Vec3::UnitY()) * displacement);
  return {along.x(), along.z(), turn};
}

GroundFrame moved(const GroundFrame& from, const GroundStep& step) {
  const double half = step.turn / 2;
  Vec3 displacement(step.x, 0, step.z);
  if (std::abs(step.turn) >= kStraight)
    displacement = std::sin(half) / half * (Eigen::AngleAxisd(half, Vec3::UnitY()) * displacement);
  const Vec3 position = from.position() + from.turn() * displacement;
  return {position.x(), position.z(), from.heading + step.turn};
}

GroundStep mixOf(const GroundStep& a, const GroundStep& b, double weight) {
  return {std::lerp(a.x, b.x, weight), std::lerp(a.z, b.z, weight), std::lerp(a.turn, b.turn, weight)};
}

GroundFrame between(const GroundFrame& a, const GroundFrame& b, double weight) {
  return {std::lerp(a.x, b.x, weight), std::lerp(a.z, b.z, weight),
          a.heading + weight * wrapped(b.heading - a.heading)};
}

void enterFrame(const MixBody& body, const GroundFrame& frame, Pose& pose) {
  const Quat back = frame.turn().conjugate();
  moveRoots(body, back, -(back * frame.position()), pose);
}

void leaveFrame(const MixBody& body, const GroundFrame& frame, Pose& pose) {
  moveRoots(body, frame.turn(), frame.position(), pose);
}

}  // namespace limber
