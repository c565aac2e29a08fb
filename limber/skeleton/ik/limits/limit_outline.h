// What a joint's limit looks like: the edge of what its bone may reach, to be drawn as a fan or a cone.
#pragma once

#include <vector>

#include "limber/skeleton/ik/limits/limits.h"

namespace limber {

struct LimitOutline {
  std::vector<Vec3> rim;  // unit vectors in the frame of the joint's parent, in order
  bool closed = false;    // a cone; else a fan
};

// bone   where the bone lies in the joint's own frame; of any length but 0
// steps  parts that the rim has, at least (fans), or rounded up to whole parts a side (cones); at least 1
//
// Twists about the bone are left out: they move no bone. Empty for joints that are free, fixed or slide, and where the
// limit leaves the bone where it is.
LimitOutline limitOutline(const JointLimit& limit, const Vec3& bone, Index steps);

}  // namespace limber
