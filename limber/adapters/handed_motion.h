// A motion and a character's skeleton as a program is given them: as BVH files, in the adapter's unit and axes.
#pragma once

#include "limber/adapters/adapter.h"
#include "limber/core/file/file.h"
#include "limber/skeleton/motion.h"

namespace limber {

// Joints under names that programs take: no blanks, braces or control characters, none empty, no two equal.
Skeleton plainlyNamed(Skeleton skeleton);

// The movement and the rest pose turned about the origin, so that no joint turns against its rest pose for it.
Motion turnedMotion(Motion motion, const Quat& turn);

// One clip of a motion at that rate, under plain names.
Bytes handedMotion(const Motion& motion, std::size_t clip, double framesPerSecond, const Adapter& adapter);

// The skeleton in its rest pose: one frame without rotations, since a BVH's rest pose has none (bvh_write.h).
Bytes handedSkeleton(const Skeleton& skeleton, double framesPerSecond, const Adapter& adapter);

}  // namespace limber
