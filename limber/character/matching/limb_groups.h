// Joints of a limb grouped as another limb's are.
#pragma once

#include <span>
#include <vector>

#include "limber/skeleton/skeleton.h"

namespace limber {

// A limb's joints (root to tip) in as many groups as the other has joints, if that has fewer: each begins nearest to
// where one of the other's does. `own` and `others` are where each joint lies along its limb, rising; own has one value
// for each of `limb`. Cost: linear in the joints for each group.
std::vector<std::vector<Index>> groupedAlong(std::span<const Index> limb, std::span<const double> own,
                                             std::span<const double> others);

}  // namespace limber
