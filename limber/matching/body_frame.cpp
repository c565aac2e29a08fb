#include "limber/matching/body_frame.h"

#include <cmath>

namespace limber {

BodyKinematics::BodyKinematics(const Skeleton& skeleton, const Quat& toBody) : skeleton_(&skeleton), toBody_(toBody) {
  units_.resize(skeleton.jointCount(), 1);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const auto& parent = skeleton.joints[j].parent;
    if (parent) units_[j] = units_[*parent] * std::cbrt(std::abs(skeleton.joints[*parent].rest.scale.prod()));
  }
}

void BodyKinematics::globals(const Pose& pose, BodyFrame& frame) const {
  frame.rotations.resize(pose.locals.size());
  frame.positions.resize(pose.locals.size());
  for (Index j = 0; j < skeleton_->jointCount(); ++j) {
    const auto& parent = skeleton_->joints[j].parent;
    const Transform& local = pose.locals[j];
    if (parent) {
      const Quat& above = frame.rotations[*parent];
      frame.rotations[j] = above * local.rotation;
      frame.positions[j] = frame.positions[*parent] + above * Vec3(units_[j] * local.translation);
    } else {
      frame.rotations[j] = toBody_ * local.rotation;
      frame.positions[j] = toBody_ * local.translation;
    }
  }
}

void BodyKinematics::place(const Pose& pose, BodyFrame& frame) const {
  for (Index j = 0; j < skeleton_->jointCount(); ++j) {
    const Vec3 way = parentRotation(j, frame) * Vec3(units_[j] * pose.locals[j].translation);
    frame.positions[j] = parentPosition(j, frame) + way;
  }
}

}  // namespace limber
