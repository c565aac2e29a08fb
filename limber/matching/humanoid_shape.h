// Which joint plays which bone of a person, told by where it is, for skeletons whose names say nothing.
#pragma once

#include <vector>

#include "limber/skeleton/humanoid_names.h"

namespace limber {

// The main joints of a person that stands upright (+Y) with both arms away from the body: two limbs that end at the
// lowest points on both sides of the middle are the legs, two that end furthest to the sides the arms, what ends
// highest is the head. Left is told by the toes, which point forward, or by bent knees; else the person faces +Z. How
// well the form fits tells the confidence (humanoid_fit.h). Nothing where the skeleton has no such form.
std::vector<HumanoidJoint> humanoidJointsByShape(const Skeleton& skeleton);

}  // namespace limber
