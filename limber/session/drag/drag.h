// Joints under the pointer, from taking hold of them to letting go.
#pragma once

#include <optional>
#include <vector>

#include "limber/session/command.h"
#include "limber/session/drag/limb_pull.h"
#include "limber/session/drag/snap.h"

namespace limber {

// A joint that moves or rotates as the dragged one does, reflected if it is its mirror image.
struct DragFollower {
  Index joint = 0;
  Mat3 reflection = Mat3::Identity();           // of directions in world space
  std::optional<Index> imageOf = std::nullopt;  // the joint whose mirror image it is
};

// What a drag works on. The skeleton and the limits must outlive it.
struct DragScene {
  const Skeleton* skeleton = nullptr;
  const JointLimits* limits = nullptr;
  Pose start;
  bool ik = false;
  std::vector<PinnedTarget> pinned;  // joints pinned while inverse kinematics is on
  double rollRadius = 1;  // metres: a pointer that moves this far rolls a root by one radian, or doubles a scale
  std::string_view solver = kLimbSolver;
  std::vector<DragFollower> followers = {};
  DragSnap snap = {};  // of the dragged joint
};

class Drag {
 public:
  // Throws Error kBadArgument for a ray or a view without direction.
  Drag(DragScene scene, Index joint, DragMode mode, const Ray& ray, const Vec3& view);

  // The pose when the pointer is there; it depends on nothing that happened between. None where the ray does not meet
  // the plane in which the joint is dragged. Errors as of the constructor. Cost: that of a pose and, with inverse
  // kinematics, of a solve: well under a millisecond at 100 joints. `snapping`: the joint's position or rotation is
  // the nearest round one.
  std::optional<Pose> at(const Ray& ray, const Vec3& view, bool snapping = false);

  // The pose with the joint moved by that offset in the world, from where it stood at the start: pulled by its limb in
  // a drag that moves, with inverse kinematics.
  Pose moved(const Vec3& offset);

  // Likewise, and turned about its own origin by a rotation vector in degrees: as a hand that has hold of it carries
  // it. A limb that is pulled comes along first. Mirror images do it reflected.
  Pose carried(const Vec3& offset, const Vec3& turn);

  // The pose with the joint turned about its own origin, from how it stood at the start. Throws Error kBadArgument for
  // an axis without direction.
  Pose turned(const Vec3& axis, double degrees);

  // The pose with the joint so many times as large as at the start, along all axes, its children with it. Throws Error
  // kBadArgument for a scale that is not above 0.
  Pose scaled(double scale) const;

  // The pose with the joint, and those that do as it does, turned so from their rest poses (CurvePoint::turn); mirror
  // images turn as far as their originals do.
  Pose turnedTo(const Vec3& turn);

  DragMode mode() const { return mode_; }
  Index joint() const { return moved_.front().joint; }
  // The joint and its followers.
  const std::vector<DragFollower>& dragged() const { return moved_; }
  const Pose& start() const { return scene_.start; }

 private:
  std::optional<Vec3> grip(const Ray& ray, const Vec3& view) const;
  void slide(Index joint, const Vec3& offset, Pose& pose) const;
  Vec3 snappedOffset(const Vec3& offset) const;
  Quat turnUnderPointer(const Vec3& grip, const Vec3& view) const;
  double scaleUnderPointer(const Vec3& grip, const Vec3& view) const;
  Quat turnTo(Index joint, const Vec3& turn) const;
  void turnAboutParent(Index joint, const Quat& rotation, Pose& pose) const;
  void swing(Index joint, const Vec3& pivot, const Quat& rotation, Pose& pose) const;

  DragScene scene_;
  DragMode mode_;
  std::vector<DragFollower> moved_;  // the dragged joint first
  std::vector<Affine> globals_;      // at the start
  double depth_ = 0;                 // of the joint before the camera, metres
  Vec3 gripAtStart_ = Vec3::Zero();
  std::vector<std::size_t> pulled_, slid_;  // of moved_: by their limbs, which come first among the targets; the others
  std::vector<PinnedTarget> targets_;
  std::optional<LimbPull> pull_;
};

}  // namespace limber
