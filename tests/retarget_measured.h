// The measures of evaluate motion for one motion, as the tests of shared models take them.
#pragma once

#include "limber/evaluate/motion_metrics.h"

namespace limber::testing {

inline MotionMetrics measured(const RetargetSetup& setup, const char* method, const PoseSequence& source) {
  return measureMotion(setup, source, retargetFrames(findRetargetMethod(method), setup, source));
}

}  // namespace limber::testing
