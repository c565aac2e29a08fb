// How much joints that were found by form look like a person.
#pragma once

#include <span>

#include "limber/skeleton/humanoid_names.h"

namespace limber {

// Sets each joint's confidence, 0.4 to 0.9, by what is least like a person who stands upright with arms away from the
// body: left and right that are no mirror images, proportions of trunk and limbs, limbs that are bent, arms that hang
// down, feet without toes (nothing then tells where the front is, and so left from right), a head that is not above,
// other limbs such as a tail or wings. Arms, legs and head are judged each by themselves, and all by the whole.
void rateHumanoidFit(const Skeleton& skeleton, std::span<HumanoidJoint> joints);

}  // namespace limber
