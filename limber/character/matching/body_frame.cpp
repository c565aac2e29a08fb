#include "limber/character/matching/body_frame.h"

#include <cmath>

namespace limber {

BodyKinematics::BodyKinematics(const Skeleton& skeleton, const Quat& toBody) : skeleton_(&skeleton), toBody_(toBody) {
  units_.resize(skeleton.jointCount(), 1);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const auto& parent = skeleton.joints[j].parent;
    if (parent) units_[j] = units_[*parent] * std::cbrt(std::abs(skeleton.joints[*parent].rest.scale.prod()));
    ends_.push_back(j + 1);
    for (std::optional<Index> above = parent; above; above = skeleton.joints[*above].parent) ends_[*above] = j + 1;
  }
}

void BodyKinematics::globals(const Pose& pose, BodyFrame& frame) const {
  frame.rotations.resize(pose.locals.size());
  frame.positions.resize(pose.locals.size());
  update(0, skeleton_->jointCount(), pose, frame);
}

void BodyKinematics::globalsBelow(Index joint, const Pose& pose, BodyFrame& frame) const {
  update(joint, ends_[joint], pose, frame);
}

void BodyKinematics::update(Index begin, Index end, const Pose& pose, BodyFrame& frame) const {
  for (Index j = begin; j < end; ++j) {
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

void BodyKinematics::update(const Pose& pose, BodyFrame& frame) const {
  updateRange(0, skeleton_->jointCount(), pose, frame);
}

void BodyKinematics::updateBelow(Index joint, const Pose& pose, BodyFrame& frame) const {
  updateRange(joint, ends_[joint], pose, frame);
}

void BodyKinematics::updateRange(Index begin, Index end, const Pose& pose, BodyFrame& frame) const {
  for (Index j = begin; j < end; ++j) {
    const Vec3 offset = parentRotation(j, frame) * Vec3(units_[j] * pose.locals[j].translation);
    frame.positions[j] = parentPosition(j, frame) + offset;
  }
}

}  // namespace limber
