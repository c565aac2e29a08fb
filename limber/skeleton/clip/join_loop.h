// The ends of a loop joined: a clip that can be played over and over without a jump.
#pragma once

#include "limber/skeleton/clip/clip.h"

namespace limber {

inline constexpr double kClosedLoop = 1e-4;  // of the skeleton's size, or of a weight: ends no farther apart are one

struct JoinedLoop {
  Clip clip;
  double gap = 0;            // how far the ends were apart: the farthest joint, in the skeleton's unit, travel aside
  double largestChange = 0;  // of a joint's position at any key
};

// The clip with its last key in the pose of its first: bit for bit, but for the roots, which end where the body has
// travelled to (over the ground, and turned about +Y). Half the difference is taken off each end and fades towards the
// middle (as 3u^2 - 2u^3 does); the difference of the speeds at the ends is taken off likewise, within 0.2 s or a third
// of the clip from each, so that the seam has no kink. After D. Holden, "Creating Looping Animations from Motion
// Capture" (2022), who spreads offsets over the clip and lets those of speed decay.
//
// body  the joint whose travel that is: the pelvis
// Linear keys in even steps, about the clip's frame rate (denseFrameRateOf). A clip whose ends agree already, within
// kClosedLoop of the skeleton's size, loops as its maker meant it to and is left as it is; so is one without duration,
// or with but two frames. The clip has passed checkClip for the skeleton; throws Error kBadArgument where `body` is no
// joint of it. Cost: O(frames * joints).
JoinedLoop joinLoop(const Skeleton& skeleton, const Clip& clip, Index body);

// The same of plain numbers, such as weights of blend shapes, however close the ends are. None leaves the range that it
// had. A track of steps jumps as it is, so it stays, as does one of one key. The track begins at 0.
Track<Vec3f> joinTrack(const Track<Vec3f>& track);

}  // namespace limber
