// Two motions played together, step by step, at the blend of their speeds.
#pragma once

#include "limber/motion/mix/gait/stride_match.h"

namespace limber {

// Each second the phase grows by the blend of what it grows in both (Kovar, Gleicher 2003): at weight 0 the first plays
// at its own speed, at 1 the second.
class JointClock {
 public:
  // Must outlive this. From that moment of the first motion on, in its seconds.
  JointClock(const StridePhases& phases, double aSeconds) : phases_(phases), a_(aSeconds) {}

  double a() const { return a_; }
  double b() const { return phases_.b.when(phase()); }
  double phase() const { return phases_.a.at(a_); }
  // Goes on by `seconds`, while the weight goes from one to the other: one step of the fourth order (Runge, Kutta).
  void advance(double seconds, double fromWeight, double toWeight);

 private:
  double speedOfA(double a, double weight) const;

  const StridePhases& phases_;
  double a_;
};

}  // namespace limber
