// A pose made with some handles, for other handles of the same model.
#pragma once

#include "limber/session/rigged_model.h"

namespace limber {

// The pose of `to` that is nearest to `from` in `pose`: each joint goes where the surface that it moves went, by the
// rigid motion that fits best there (weighted least squares over its vertices; Kabsch 1976). A joint that moves too
// little of the surface to tell follows the joint above it. The result is `to.home`, bit for bit, where `pose` is
// `from.home`, and where the two do not hold the same vertices (a file's own rig can bind its parts elsewhere). Cost:
// O(#S).
Pose transferPose(const RiggedModel& from, const Pose& pose, const RiggedModel& to);

}  // namespace limber
