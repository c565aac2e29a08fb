// A body's travel taken out of its joints: thrown away, or handed to a root joint above them.
#pragma once

#include "limber/skeleton/clip/root_trajectory.h"

namespace limber {

// Both take the trajectory of this very clip. The clip has passed checkClip for the skeleton. Joints that change get
// linear tracks; all others keep theirs.

// The clip without that travel: the body stays above its rest position. Feet then slide over the ground, by design. The
// travel is taken out of the topmost joints that move (movingRoots), and joints that do not move are not involved;
// where none of them carries the body, which then does not move, out of the roots.
//
// body  the joint that the trajectory was made of
Clip clipInPlace(const Skeleton& skeleton, const Clip& clip, Index body, const RootTrajectory& trajectory);

// The clip with that travel in `root`, the only root of the skeleton, and the rest of the movement in the joints that
// hang on it. The joint's own movement, if it has any, goes to these. All other joints are where they were: at the keys
// but for rounding, between them within 5e-7 of the skeleton's size, for which keys are added where a turning root
// needs them. Throws Error kBadArgument where `root` is not the only root or its rest transform has no inverse.
Clip extractRootMotion(const Skeleton& skeleton, const Clip& clip, Index root, const RootTrajectory& trajectory);

}  // namespace limber
