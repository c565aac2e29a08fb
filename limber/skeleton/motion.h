// What a motion file holds: a skeleton, and clips that move it.
#pragma once

#include "limber/core/error.h"
#include "limber/skeleton/clip/clip.h"

namespace limber {

// Lengths in metres and +Y up, as far as the file tells (bvh_read.h says what a BVH does not). A joint named "..._end"
// that no clip moves is the end of its parent's bone: a BVH's end site, or what other programs export for the same.
struct Motion {
  std::string name;             // the file's, without folder and extension
  Skeleton skeleton;            // in rest pose; often a T-pose, but nothing guarantees that
  std::vector<Clip> clips;      // each has passed checkClip; values replace those of the rest pose
  double framesPerSecond = 30;  // as the file says, else that of the first clip (measuredFrameRate)
  Warnings warnings;            // what reading had to convert or repair
};

// Throws Error kBadData where the skeleton or a clip breaks its rules or the frame rate is not positive and finite.
void checkMotion(const Motion& motion);

// When the track with the most keys has them, the first of several; empty where no track has one.
std::vector<float> longestTimes(const Clip& clip);

// Keys a second of the track with the most keys: one over the median distance between neighbours, a whole number
// where it is one to within rounding; nullopt where no track has two keys.
std::optional<double> measuredFrameRate(const Clip& clip);

// The same as a rate to sample the clip at: 1 to 1000, 30 where its keys do not tell.
double frameRateOf(const Clip& clip);

// The same for work that goes from frame to frame. No recording has fewer than 20 keys a second; of a clip that has,
// since they were set by hand or reduced, much lies between two keys: there it is the least multiple of their rate that
// is at least 30, so that keys stay frames.
double denseFrameRateOf(const Clip& clip);

// Frames a second of one of the clips: the motion's own where they are about the clip's or its keys do not tell, else
// measuredFrameRate.
double frameRateOf(const Motion& motion, std::size_t clip);

// How many frames a clip has at that rate: those at 0, 1/rate, 2/rate, ... up to its duration, which may lie up to half
// a frame beyond the last or before it. At least 1. Throws Error kBadArgument for a rate that is not positive and
// finite, kLimit beyond 2^30 frames.
Index frameCount(const Clip& clip, double framesPerSecond);

}  // namespace limber
