// A skeleton as retargeting wants it: rotations and lengths, no mirror images.
#pragma once

#include <vector>

#include "limber/character/matching/retarget_setup.h"

namespace limber {

// The same skeleton without negative scales, and with scales that are even in all directions. Joints keep their
// numbers. Where scales are negative but even, every joint has the same world position as in the original; scales that
// differ between axes become their geometric mean, so that bones below them are a little off.
class PlainSkeleton {
 public:
  explicit PlainSkeleton(const Skeleton& original);

  const Skeleton& skeleton() const { return skeleton_; }
  // Frames of the original as frames of skeleton(), and back with the original's scales at rest. Scales that change
  // take joints along, as they do in the original.
  PoseSequence plain(PoseSequence frames) const;
  PoseSequence original(PoseSequence frames) const;

 private:
  void mirror(Transform& local, Index joint) const;
  void takeScales(Pose& pose) const;

  Skeleton skeleton_;
  std::vector<Vec3> signs_;   // #J, of the axes of the space in which the joint's local transform is given
  std::vector<Vec3> scales_;  // #J, of the original
};

}  // namespace limber
