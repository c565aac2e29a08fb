// Rest poses that tell nothing of a body: programs that zero their joints' axes write all bones along one line.
#pragma once

#include <optional>
#include <span>

#include "limber/character/matching/skeleton_map.h"
#include "limber/skeleton/motion.h"

namespace limber {

// False where a skeleton with four limbs or more has the bones of all limbs along one line, to either side of it: what
// is arm, leg or trunk, up or ahead cannot be seen in that pose. A limb is a chain of two bones or more that parts from
// others; what leads to where it begins, and from the root to the hips, does not count. Cost: one pass over the joints.
bool hasForm(const Skeleton& skeleton, const Pose& pose);

// The pose that replaces a rest pose without form when a body is read: the tallest (+Y up) of the motion's poses that
// have one, turned about +Y to face +Z. None where the rest pose has a form, or no pose of the motion.
std::optional<Pose> poseWithForm(const Skeleton& skeleton, std::span<const Pose> motion);
// The same of all clips, looked at evenly spaced moments.
std::optional<Pose> poseWithForm(const Motion& motion);

// The skeleton with another rest pose; both hold #J locals.
Skeleton restingIn(Skeleton skeleton, const Pose& pose);

// The motion's skeleton, resting in that pose where there is one: for whoever asks what its joints are.
Skeleton skeletonWithForm(const Motion& motion);

// matchSkeletons(), with the source read in that pose where there is one.
//
// source  of the motion's skeleton
SkeletonMap matchMotion(const Motion& motion, const SkeletonReading& source, const SkeletonReading& target,
                        bool unlikeBodies = false);

}  // namespace limber
