// How far a leg reaches where it bends as the source's does. Feet that follow the source's path, whatever the joint
// angles (FootDrive), say nothing about the legs above them.
#pragma once

#include <vector>

#include "limber/character/matching/retarget_setup.h"
#include "limber/core/text/numbers.h"

namespace limber {

// Radians; pi / 2 to 2.6; the bend of a knee: it folds further only where a body lies on its legs; set by hand.
inline constexpr double kMaxBend = 2 * kPi / 3;

class LegBend {
 public:
  LegBend(const RetargetSetup& setup, const LegJoints& source, const LegJoints& target);

  // From the target's upper joint to its end, metres. Its knee bends by as much more or less than in its neutral pose
  // as the source's does; a leg with a hock counts as two equal bones that make up the whole chain. It comes without a
  // kink to straight and to its most bend: kMaxBend, with a hock where its longest bone lets it fold no further.
  double reach(const BodyFrame& source) const;

 private:
  // One side's leg as two bones.
  struct Chain {
    Chain(const Skeleton& skeleton, const NeutralPose& neutral, const LegJoints& leg);
    // Of the second bone against the first, radians; a little more of a leg that is nearly straight.
    double bendAt(double reach) const;
    double reachAt(double bend) const;
    double bend(const std::vector<Vec3>& positions) const;

    Index upper, end;
    double first, second;
    double most = 2.3;  // by bendAt(), radians; 2.1 to 2.8; of a leg without a hock; set by hand
    double atRest;      // its bend in the neutral pose
  };

  Chain source_, target_;
};

}  // namespace limber
