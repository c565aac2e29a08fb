// A BVH that comes line by line, as programs of motion capture send it: the hierarchy once, then a row for each frame.
#pragma once

#include <memory>
#include <string>

#include "limber/document/bvh/bvh_frames.h"
#include "limber/document/bvh/bvh_hierarchy.h"
#include "limber/skeleton/pose.h"

namespace limber {

// Lengths are taken as metres; Z up is inferred from the rest pose alone (bvh_read.h), and the roots turned. "Frames:"
// and "Frame Time:" may stand in front of the rows or not.
class BvhStream {
 public:
  BvhStream();

  // Takes the next piece of the text, wherever it is cut. Throws Error kBadData, naming the line, where it is no BVH, a
  // row has another number of numbers or one that is not finite; kLimit beyond 1000 joints and lines of 64 KiB.
  void take(std::string_view text);

  // Null before MOTION; then it stays.
  const Skeleton* skeleton() const { return frames_ ? &skeleton_ : nullptr; }
  // Rows so far, and the locals of the joints in the last one (at first the rest pose).
  std::size_t rows() const { return rows_; }
  const Pose& pose() const { return pose_; }

 private:
  void takeLine(std::string_view text);
  void takeRow(std::string_view text);
  void begin();

  std::string begun_;
  std::size_t lines_ = 0, rows_ = 0;
  BvhHierarchy hierarchy_;
  std::unique_ptr<BvhFrames> frames_;
  std::vector<double> values_;
  Skeleton skeleton_;
  Quat turn_;
  Pose pose_;
};

}  // namespace limber
