// How far an animal's leg reaches where it bends as the source's does. Feet on roots of their own go the source's way,
// which says nothing about the legs above them.
#pragma once

#include <vector>

#include "limber/retarget/retarget_setup.h"

namespace limber {

class LegBend {
 public:
  LegBend(const RetargetSetup& setup, const AnimalLeg& leg);

  // From the target's upper joint to its end, metres. Both legs count as two equal bones that make up the whole chain;
  // the target's bends by as much more or less than in its neutral pose as the source's does, and comes to straight
  // without a kink.
  double reach(const BodyFrame& source) const;

 private:
  // One side's leg.
  struct Chain {
    Chain(const Skeleton& skeleton, const NeutralPose& neutral, const LegJoints& leg);
    // Of each of the two bones against the line from end to end, radians.
    double bend(const std::vector<Vec3>& positions) const;

    Index upper, end;
    double length = 0;
    double atRest;  // its bend in the neutral pose
  };

  Chain source_, target_;
};

}  // namespace limber
