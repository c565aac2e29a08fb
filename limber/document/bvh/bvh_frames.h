// The second half of a BVH file: rows of channel values, as tracks.
#pragma once

#include <span>
#include <vector>

#include "limber/document/bvh/bvh_hierarchy.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// Collects frames and turns them into a clip. Lengths and axes are the file's.
class BvhFrames {
 public:
  explicit BvhFrames(std::span<const BvhJoint> joints);

  // One value for each channel, in the file's order, all finite.
  void addFrame(std::span<const double> values);
  std::size_t count() const { return count_; }

  // Have the joints below the roots positions that are to be added to their offsets? Where it is not clear, not.
  bool positionsAreRelative() const {
    constexpr double kClearly = 0.1;
    return squaresOfRelative_ < kClearly * squaresOfAbsolute_;
  }

  // The frames so far; they are then gone from here. Tracks of one value have one key, but that the clip lasts as long
  // as its frames.
  Clip takeClip(double framesPerSecond);

 private:
  struct Tracks {
    Index joint = 0;
    bool root = false;
    Vec3 offset;
    std::vector<BvhChannel> channels;
    bool positions = false, rotations = false, scales = false;  // has it such channels?
    std::vector<Vec3f> positionValues, scaleValues;
    std::vector<Eigen::Quaternionf> rotationValues;
  };
  void addRotation(Tracks& tracks, const Quat& rotation);

  std::vector<Tracks> moving_;
  std::size_t count_ = 0;
  double squaresOfAbsolute_ = 0, squaresOfRelative_ = 0;  // of the distances from the offsets, for both interpretations
};

}  // namespace limber
