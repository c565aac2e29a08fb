// How far people's joints go: default limits for humanoid skeletons.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "limber/skeleton/humanoid_bones.h"
#include "limber/skeleton/ik/limits/limits.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// Ranges of motion of one humanoid bone, in degrees, of healthy adults. `bone` is its VRM 1.0 name; for bones of a side
// without "left" or "right" and for the left.
struct HumanoidRange {
  std::string_view bone;
  std::string_view tip;     // the bone to which it points
  std::string_view source;  // where the figures are from
};
std::span<const HumanoidRange> humanoidRanges();

// #J limits; joints that play no bone, and the hips, are free. The character faces +Z with its left at +X. Its rest
// pose may be any in which bones twist as in a T-pose (palms down or forward along the arms): the limits' neutral
// rotations are found by first bending it to a T-pose. The spine's range is shared among the spine bones there are, the
// neck's between neck and head. Throws Error kBadArgument for a bone or joint that is not there.
JointLimits humanoidLimits(const Skeleton& skeleton, std::span<const HumanoidJoint> joints);

}  // namespace limber
