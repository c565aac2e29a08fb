// Feet of a mixed motion slide no more than they did in its motions.
#pragma once

#include "limber/motion/mix/mixed_frames.h"

namespace limber {

struct MixedRange {
  std::size_t begin = 0, end = 0;  // frames; none before and none behind change
  bool loops = false;              // the last frame changes as the first one does
};

// Where two motions mix, a foot that both have planted slides: their legs swing by other lengths. The pelvis and the
// feet move by the smallest and smoothest changes after which each planted foot takes the steps that its motions take
// (MixedFoot), by its ankle or its toes, whichever these move less; one least squares over all frames (LeastChanges, as
// the method "spacetime"), then the legs are solved for (LimbReach). None goes further below the ground or beyond its
// leg. Nothing where nothing would slide. Linear in the frames, about 20 us for each.
void plantMixedFeet(const MixBody& body, const MixedRange& range, MixedFrames& mixed);

}  // namespace limber
