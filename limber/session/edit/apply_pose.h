// Poses of pose files on the model of a session.
#pragma once

#include "limber/session/command.h"
#include "limber/session/rigged_model.h"

namespace limber {

// What `now` becomes by the command. Throws Error as poseFromJson, putPose and mirrorOfRig do, and kBadArgument for a
// joint that is not there.
Pose appliedPose(const RiggedModel& rig, const Pose& now, const ApplyPose& command);

}  // namespace limber
