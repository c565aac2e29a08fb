// When a point of a foot rests on the ground, detected causally, without looking ahead.
#pragma once

#include <array>
#include <cstddef>

#include "limber/core/types.h"

namespace limber {

// All lengths in metres of the skeleton that is watched; hip heights make the thresholds independent of its size.
// Set by hand.
struct PlantThresholds {
  double enterSpeed = 0.3, leaveSpeed = 0.7;      // hip heights a second; 0.1 to 1, the first below the second
  double leaveRise = 0.3;                         // likewise, upward; 0.1 to 0.7
  double enterHeight = 0.05, leaveHeight = 0.09;  // hip heights over where the point is when standing; 0.02 to 0.15
};

class PlantDetector {
 public:
  PlantDetector(double hipHeight, const PlantThresholds& thresholds = {})
      : hipHeight_(hipHeight), thresholds_(thresholds) {}

  // `height` is that of the point over where it is when standing. The first frame counts as unmoved. Speed is seen
  // over a few frames and so comes late; a point that slows down counts as slow as it will be by then.
  bool next(const Vec3& position, double height, double seconds);
  // Forgets what was, as before the first frame: the motion jumped.
  void reset();

 private:
  double hipHeight_;
  PlantThresholds thresholds_;
  struct Seen {
    Vec3 position = Vec3::Zero();
    double seconds = 0;  // since the one before
  };
  // Over the frames before the last `skipped`.
  Vec3 velocity(std::size_t skipped) const;
  double speedAhead() const;

  std::array<Seen, 32> seen_;  // the last frames, in a ring
  std::size_t count_ = 0;      // of all frames
  bool planted_ = false;
};

}  // namespace limber
