// How large the body of a skeleton is, and whether people and quadrupeds come in that size.
#pragma once

#include <optional>
#include <span>

#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/core/error.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// In the skeleton's unit. Joints of props and attachments, and of no part, do not count; where there are no others, all
// do. The highest joint is below the top of the head, so a person is about a tenth taller.
struct SkeletonSize {
  double height = 0;           // from the lowest joint to the highest, along Anatomy::axes.up
  double longestSide = 0;      // of the box around the joints, whatever the body's orientation
  std::optional<double> hips;  // height of the trunk's first joint above the lowest joint; none without a trunk
};

// anatomy  readAnatomy(skeleton), of the rest pose; `pose` may be another
SkeletonSize skeletonSize(const Skeleton& skeleton, const Pose& pose, const Anatomy& anatomy);

// Adds the warning "unlikely-size" where the body reads as a person or a quadruped (a head, one or two pairs of legs,
// no wings) and is below 0.3 m or above 10 m, in rest pose as well as at the beginning of the first clip that moves it:
// mostly its unit is another. Lengths are metres.
//
// clips  of the skeleton; none: the rest pose alone counts
void warnUnlikelySize(const SkeletonReading& skeleton, std::span<const Clip> clips, Warnings& warnings);

}  // namespace limber
