// What the tests of shared models measure of a motion.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "limber/evaluate/motion/motion_metrics.h"
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

// One figure of every pair of a motion and a body. A bound on each would be as loose as the worst pair asks for; so
// there is one for nearly all as well, whichever they are.
class Spread {
 public:
  void add(double value, std::string pair) { values_.emplace_back(value, std::move(pair)); }
  // At least that fraction of the pairs is below.
  void expectBelow(double bound, double fraction, const char* what) {
    ASSERT_FALSE(values_.empty()) << what;
    std::sort(values_.begin(), values_.end());
    const auto above = std::find_if(values_.begin(), values_.end(), [&](const auto& v) { return !(v.first < bound); });
    const double below = static_cast<double>(above - values_.begin()) / static_cast<double>(values_.size());
    EXPECT_GE(below, fraction) << what << " is not below " << bound << " for " << values_.end() - above << " of "
                               << values_.size() << " pairs; at worst " << values_.back().first << ": "
                               << values_.back().second;
  }
  void expectAllBelow(double bound, const char* what) { expectBelow(bound, 1, what); }

 private:
  std::vector<std::pair<double, std::string>> values_;
};

// What feet and ground ask for, pair by pair.
struct Spreads {
  Spread depth;    // of feet below the ground, more than the source's, millimetres of somebody 1.7 m tall
  Spread slides;   // of planted feet, more than the source's own, heights a second
  Spread sliding;  // of planted feet, likewise
  Spread jerk;     // over the source's
  Spread turned;   // bones, degrees, mean
  Spread lost;     // contacts, fraction
  Spread free;     // fraction of the frames in which the source's feet are not planted

  void add(const MotionMetrics& result, double sourceDepth, const std::string& pair) {
    depth.add(1700 * (result.penetration - sourceDepth), pair);
    slides.add(result.sliding - result.sourceSliding, pair);
    sliding.add(result.sliding, pair);
    jerk.add(result.jerk, pair);
    turned.add(result.boneDirection, pair);
    lost.add(1 - result.contactAgreement, pair);
    free.add(1 - result.planted, pair);
  }
  // Else bounds on planted feet would hold for want of any.
  void expectPlantedFeet() { free.expectBelow(0.95, 0.5, "share of frames without a planted foot"); }
};

}  // namespace limber::testing
