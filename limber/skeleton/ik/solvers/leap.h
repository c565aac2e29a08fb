// Makes methods that creep go faster: on in the direction of the last sweep, as far as that gains.
#pragma once

#include "limber/skeleton/ik/ik_system.h"

namespace limber {

// For sweeps over the joints (CCD, FABRIK), which zigzag where limbs have joints in common, where limits apply and
// where a chain is almost straight. After a sweep every joint goes on by the rotation it has just made, times a factor
// that doubles with each success and halves otherwise (pattern moves; Hooke, Jeeves: Direct search solution of
// numerical and statistical problems, 1961). Takes no memory after construction. Cost: a few sweeps' forward passes.
class Leap {
 public:
  explicit Leap(const IkSystem& system) : before_(system.makeState()), after_(before_) {}

  void restart() { factor_ = 1; }
  // Before the sweep.
  void mark(const IkSystem& system) { system.save(before_); }
  // After it: leaps, or leaves the system as it is where that would not lower the cost. Returns the cost.
  double take(IkSystem& system);

 private:
  IkSystem::State before_, after_;
  double factor_ = 1;
};

// How much a joint above several effectors heeds each of them: the effector's weight, less the nearer it is to its
// target against that of the one furthest from it. By the given weights alone, effectors that have arrived hold back
// those that have not, though their own limbs could make good what it costs them. #effectors.
void heedTheFurthest(const IkSystem& system, std::vector<double>& weights);

}  // namespace limber
