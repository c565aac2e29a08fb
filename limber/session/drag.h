// A joint under the pointer, from taking hold of it to letting go.
#pragma once

#include <optional>
#include <vector>

#include "limber/session/command.h"
#include "limber/session/limb_pull.h"

namespace limber {

// What a drag works on. The skeleton and the limits must outlive it.
struct DragScene {
  const Skeleton* skeleton = nullptr;
  const JointLimits* limits = nullptr;
  Pose start;
  bool ik = false;
  std::vector<HeldTarget> held;  // joints that hold on to a place, with inverse kinematics on
  double rollRadius = 1;         // metres: a root that the pointer moves this far rolls by one radian
  std::string_view solver = kLimbSolver;
};

class Drag {
 public:
  // Throws Error kBadArgument for a ray or a view without direction.
  Drag(DragScene scene, Index joint, DragMode mode, const Ray& ray, const Vec3& view);

  // The pose when the pointer is there; it depends on nothing that happened between. None where the ray does not meet
  // the plane in which the joint is dragged. Errors as of the constructor. Cost: that of a pose and, with inverse
  // kinematics, of a solve: well under a millisecond at 100 joints.
  std::optional<Pose> at(const Ray& ray, const Vec3& view);

  // The pose with the joint turned about its own origin, from how it stood at the start. Throws Error kBadArgument for
  // an axis without direction.
  Pose turned(const Vec3& axis, double degrees);

  Index joint() const { return joint_; }
  const Pose& start() const { return scene_.start; }

 private:
  std::optional<Vec3> grip(const Ray& ray, const Vec3& view) const;
  void slide(const Vec3& offset, Pose& pose) const;
  void turn(const Vec3& grip, const Vec3& view, Pose& pose) const;
  void swing(Index joint, const Vec3& pivot, const Quat& rotation, Pose& pose) const;

  DragScene scene_;
  Index joint_ = 0;
  DragMode mode_;
  std::vector<Affine> globals_;  // at the start
  double depth_ = 0;             // of the joint before the camera, metres
  Vec3 gripAtStart_ = Vec3::Zero();
  std::vector<HeldTarget> targets_;
  LimbPull pull_;
  bool pullsJoint_ = false;  // the first target is the dragged joint's
};

}  // namespace limber
