// Live motion as the program hands it to the studio's page: a skeleton once, then its joints' locals frame by frame.
#pragma once

#include <string>
#include <string_view>

#include "limber/core/file/file.h"
#include "limber/skeleton/pose.h"

namespace limber {

// {"joints": [{"name", "parent" (a number or null), "rest": [x, y, z of the position, x, y, z, w of the rotation]}]},
// in one line. Scales are left out.
std::string liveSkeletonText(const Skeleton& skeleton);
// Throws Error kBadData where the text is none such, a rotation is not of unit length within 1e-3, or as checkSkeleton
// does; kLimit beyond 1000 joints.
Skeleton liveSkeletonFrom(std::string_view text);

// [seconds, seven numbers for each joint as above], in one line.
std::string liveFrameText(const Pose& pose, double seconds);

// A pose out of those numbers as little-endian floats. Throws Error kBadData where they are not seven for each joint,
// not finite, or a rotation is not of unit length within 1e-3.
Pose livePoseFrom(ByteSpan floats);

}  // namespace limber
