// Motions as BVH files.
#pragma once

#include <optional>

#include "limber/core/file/file.h"
#include "limber/skeleton/motion.h"

namespace limber {

// Frames a second for a clip of the motion: its rate, or the least multiple of it, up to 240, at which all its keys but
// the last are frames; where there is none, a multiple of at least 60.
double bvhFrameRate(const Motion& motion, std::size_t clip);

struct BvhWriteOptions {
  std::size_t clip = 0;       // which of the motion's
  double metresPerUnit = 1;   // lengths are divided by it; a BVH does not say its unit
  std::optional<double> fps;  // frames a second; none: bvhFrameRate
};

// The text of a BVH file: one clip, sampled from its start to its end. Joint positions come out as they are whatever
// the skeleton: rest rotations and scales go into the offsets, a root gets position channels, and so does any other
// joint whose distance from its parent changes. Rotations are written as Z, X, Y, each frame's the nearest to those of
// the one before. Leaves named "..._end" without a track become end sites; other leaves get one without length.
// Changing scales are not written (BVH has none), only what they do to positions.
//
// Throws Error kBadArgument where there is no such clip, no joint, or a name holds a line break or brace; kLimit
// where joints times frames are more than 2^24.
Bytes writeBvh(const Motion& motion, const BvhWriteOptions& options = {});

}  // namespace limber
