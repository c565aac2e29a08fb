// Scales that a clip changes.
#pragma once

#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

// The joints whose scale a clip has off the rest pose by more than a thousandth, in the order of the clip's tracks:
// what formats and methods that know rotations and translations alone leave out.
std::vector<Index> jointsWithScales(const Skeleton& skeleton, const Clip& clip);

}  // namespace limber
