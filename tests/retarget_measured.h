// What the tests of shared models measure of a motion.
#pragma once

#include <algorithm>

#include "limber/evaluate/motion_metrics.h"
#include "limber/skeleton/chain.h"

namespace limber::testing {

inline MotionMetrics measured(const RetargetSetup& setup, const char* method, const PoseSequence& source) {
  return measureMotion(setup, source, retargetFrames(findRetargetMethod(method), setup, source));
}

// Of an animal's leg in the target.
inline bool isOfLeg(const RetargetSetup& setup, Index joint) {
  return std::any_of(setup.animalLegs.begin(), setup.animalLegs.end(), [&](const AnimalLeg& leg) {
    return isAncestorOrSelf(*setup.target, leg.target.upper, joint) ||
           isAncestorOrSelf(*setup.target, leg.target.end, joint);
  });
}

}  // namespace limber::testing
