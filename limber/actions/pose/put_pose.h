// A pose of one skeleton on another one.
#pragma once

#include "limber/skeleton/portable_pose.h"

namespace limber {

// The same skeleton (poseByNames) gets the pose bit for bit. Any other one takes it by anatomy, as motions are
// retargeted: bones point as there, the body is as high over the ground as its legs are long, and soles that are on the
// ground there are on it here. It stays where it is: the middle between its feet is, seen from above, where `now` has
// it. Throws Error kUnsupported where the two bodies have too little in common.
Pose putPose(const PortablePose& pose, const Skeleton& to, const Pose& now);

}  // namespace limber
