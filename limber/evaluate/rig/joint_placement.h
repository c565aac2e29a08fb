// Whether joints lie where joints can lie, told from the surface alone.
#pragma once

#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// inside     fraction of the joints that lie within the surface: a winding number above a half
// offCenter  0 where a joint lies in the middle of the limb, 1 where it lies on the surface or outside, mean over the
//            joints. Of a joint inside: |a - b| / (a + b), mean over eight chords through it at right angles to its
//            bone that leave the body at a and b (BodyInside); joints without such a chord do not count.
struct JointPlacement {
  double inside = 0, offCenter = 0;
};

// model   welded (weldedModel)
// counts  #J: joints that count (countedJoints); at least one
// Cost: O(#F log #F) for the trees, then O(log #F) a joint in practice.
JointPlacement measureJointPlacement(const SkinnedModel& model, const std::vector<bool>& counts);

}  // namespace limber
