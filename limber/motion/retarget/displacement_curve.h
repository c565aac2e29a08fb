// A number for each frame of a motion: the smallest and smoothest change that does what is asked of it.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace limber {

// What a curve has to do in one frame. Weights count against `pull` on curves that move in DisplacementCurve's time.
struct CurveGoal {
  double value = 0, valueWeight = 0;  // to be `value`
  double step = 0, stepWeight = 0;    // to be the frame before and `step`
  double least = -std::numeric_limits<double>::infinity();
  bool cut = false;  // has nothing to do with the frame before
};

struct CurveOptions {
  double seconds = 0.15;   // in which it comes and goes, unasked
  double pull = 1;         // towards 0; not 0 where goals leave a stretch between cuts to itself
  double minWeight = 1e6;  // of what it is below `least`, like a valueWeight
};

// Least squares over all frames: pull d^2, goals, and (seconds / frameSeconds)^6 times the squared third differences
// (Whittaker's smoothing, of order three: what moves smoothest has the least jerk). Lower bounds by an active set.
// Time and memory linear in the number of frames.
std::vector<double> displacementCurve(std::span<const CurveGoal> goals, double frameSeconds,
                                      const CurveOptions& options = {});

}  // namespace limber
