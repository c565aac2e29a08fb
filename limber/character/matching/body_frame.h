// A skeleton's joints at one moment, in the space of the person: up +Y, left +X.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/pose.h"

namespace limber {

// The level part of a displacement.
inline Vec3 alongGround(const Vec3& displacement) {
  return {displacement.x(), 0, displacement.z()};
}

struct BodyFrame {
  std::vector<Quat> rotations;  // #J, global
  std::vector<Vec3> positions;  // #J, global
};

// What it takes to get there from a pose. Scales are those of the rest pose and taken as even in all directions.
class BodyKinematics {
 public:
  // The skeleton must outlive this.
  BodyKinematics(const Skeleton& skeleton, const Quat& toBody);

  const Skeleton& skeleton() const { return *skeleton_; }
  const Quat& toBody() const { return toBody_; }

  // One pass, no allocation once `frame` has its size. About 20 ns for each joint.
  void globals(const Pose& pose, BodyFrame& frame) const;
  // Of a joint and of what hangs on it, where nothing else has changed.
  void globalsBelow(Index joint, const Pose& pose, BodyFrame& frame) const;
  // Positions from rotations that are there already, and from the locals' translations.
  void update(const Pose& pose, BodyFrame& frame) const;
  void updateBelow(Index joint, const Pose& pose, BodyFrame& frame) const;

  Quat parentRotation(Index joint, const BodyFrame& frame) const {
    const auto& parent = skeleton_->joints[joint].parent;
    return parent ? frame.rotations[*parent] : toBody_;
  }
  Vec3 parentPosition(Index joint, const BodyFrame& frame) const {
    const auto& parent = skeleton_->joints[joint].parent;
    return parent ? frame.positions[*parent] : Vec3(Vec3::Zero());
  }
  // How long a unit of the joint's local translation is in the person's space.
  double unit(Index joint) const { return units_[joint]; }

 private:
  void update(Index begin, Index end, const Pose& pose, BodyFrame& frame) const;
  void updateRange(Index begin, Index end, const Pose& pose, BodyFrame& frame) const;

  const Skeleton* skeleton_;
  Quat toBody_;
  std::vector<double> units_;  // #J
  std::vector<Index> ends_;    // #J, past the last joint below
};

}  // namespace limber
