// The frames of a motion as a curve: poses at any moment, without the kinks that straight lines between frames have.
#pragma once

#include <array>
#include <cstddef>

#include "limber/character/matching/retarget_setup.h"

namespace limber {

// Frame lengths; 1e-9 to 1e-3; a time that is less off a frame is at it, and a frame that lacks less is whole; rounding
// only.
inline constexpr double kWholeFrame = 1e-6;

// How much which frames count at a moment between frames: with the speeds of Catmull-Rom (1974), at an end that of the
// parabola through the last three. `at` in frames, from 0 to the last.
struct CurveWeights {
  std::array<std::size_t, 4> frames;
  std::array<double, 4> weights;
};
CurveWeights curveWeights(double at, std::size_t frameCount);

// Through all frames, as curveShares tells: translations by their components, rotations by those of
// their quaternions, made unit again. Scales go straight. At a frame it is that frame, bit for bit. A joint that turns
// by more than 45 degrees from one frame to the next has flipped, as a thigh about its own axis does where a knee is
// straight: between such two it is as in the nearer one.
class PoseCurve {
 public:
  // At least one frame; must outlive this.
  explicit PoseCurve(const PoseSequence& frames) : frames_(frames) {}

  double duration() const { return static_cast<double>(frames_.poses.size() - 1) * frames_.frameSeconds; }
  // The first and the last pose stay before and after.
  void sample(double seconds, Pose& pose) const;

 private:
  const PoseSequence& frames_;
};

}  // namespace limber
