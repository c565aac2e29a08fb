#include "limber/motion/mix/gait/joint_clock.h"

#include <cmath>

namespace limber {

double JointClock::speedOfA(double a, double weight) const {
  const double ofA = phases_.a.rate(a), ofB = phases_.b.rate(phases_.b.when(phases_.a.at(a)));
  return std::lerp(ofA, ofB, weight) / ofA;
}

void JointClock::advance(double seconds, double fromWeight, double toWeight) {
  const double half = seconds / 2, middle = (fromWeight + toWeight) / 2;
  const double first = speedOfA(a_, fromWeight), second = speedOfA(a_ + half * first, middle);
  const double third = speedOfA(a_ + half * second, middle), fourth = speedOfA(a_ + seconds * third, toWeight);
  a_ += seconds * (first + 2 * (second + third) + fourth) / 6;
}

}  // namespace limber
