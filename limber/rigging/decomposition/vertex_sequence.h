// A mesh that moves without anybody saying how: where each of its points is in each frame.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Points are stored eight side by side, frame by frame, so that sums over frames are taken for eight at a time.
// Memory: 12 bytes a point and frame, and 12 a point. Points beyond the last that fill up the last block stay at the
// origin.
class VertexSequence {
 public:
  static constexpr Index kLanes = 8;
  static constexpr std::size_t kFrameSize = 3 * kLanes;  // floats of one block in one frame: x of eight points, y, z

  static constexpr double kMaxFrames = 1 << 20;  // nine hours at 30 a second
  static constexpr double kMaxPositions = 2e9;   // stored, those that fill up the last block among them: 24 GB

  // Throws Error kLimit beyond kMaxFrames or kMaxPositions. Numbers that may not be whole, as those of untrusted
  // files.
  static void checkSize(double pointCount, double frameCount);

  // A sequence of a size that is not known to be sound. Throws as checkSize does.
  static VertexSequence forFrames(std::size_t pointCount, std::size_t frameCount) {
    checkSize(static_cast<double>(pointCount), static_cast<double>(frameCount));
    return {static_cast<Index>(pointCount), static_cast<Index>(frameCount)};
  }

  // Both 0 or more.
  VertexSequence(Index pointCount, Index frameCount)
      : rest(pointCount, Vec3f::Zero()),
        frameCount_(frameCount),
        values_(std::size_t{blockCount()} * frameCount * kFrameSize, 0.0f) {}

  Index pointCount() const { return static_cast<Index>(rest.size()); }
  Index frameCount() const { return frameCount_; }
  Index blockCount() const { return (pointCount() + kLanes - 1) / kLanes; }

  // Points of a block; fewer than kLanes in the last.
  Index pointsIn(Index block) const { return std::min(kLanes, pointCount() - block * kLanes); }

  Vec3f at(Index point, Index frame) const {
    const float* x = frameOf(point / kLanes, frame) + point % kLanes;
    return {x[0], x[kLanes], x[2 * kLanes]};
  }
  void set(Index point, Index frame, const Vec3f& position) {
    float* x = values_.data() + offset(point / kLanes, frame) + point % kLanes;
    for (Index i = 0; i < 3; ++i) x[i * kLanes] = position[i];
  }

  // The eight points of a block in a frame: kFrameSize floats, those of the next frame behind them.
  const float* frameOf(Index block, Index frame) const { return values_.data() + offset(block, frame); }

  std::vector<Vec3f> rest;  // #points, where each is bound

 private:
  std::size_t offset(Index block, Index frame) const { return (std::size_t{block} * frameCount_ + frame) * kFrameSize; }

  Index frameCount_ = 0;
  std::vector<float> values_;
};

}  // namespace limber
