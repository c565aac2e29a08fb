// How far an animal's leg reaches where it bends as the source's does. Feet that go the source's way, whatever the
// joint angles (RootPlacer::goesOwnWay), say nothing about the legs above them.
#pragma once

#include <vector>

#include "limber/matching/retarget_setup.h"

namespace limber {

class LegBend {
 public:
  LegBend(const RetargetSetup& setup, const AnimalLeg& leg);

  // From the target's upper joint to its end, metres. Both legs count as two equal bones that make up the whole chain;
  // the target's bends by as much more or less than in its neutral pose as the source's does. It comes without a kink
  // to straight, and to where its longest bone lets it fold no further.
  double reach(const BodyFrame& source) const;

 private:
  // One side's leg.
  struct Chain {
    Chain(const Skeleton& skeleton, const NeutralPose& neutral, const LegJoints& leg);
    // Of each of the two bones against the line from end to end, radians.
    double bend(const std::vector<Vec3>& positions) const;

    Index upper, end;
    double length = 0, folded = 0;  // from end to end at most and at least
    double atRest;                  // its bend in the neutral pose
  };

  Chain source_, target_;
};

}  // namespace limber
