// Commands that pose the model, and what pinned joints do then.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "limber/session/session.h"

namespace limber {

void apply(const SetIk& c, SessionState& next);
void apply(const SetTarget& c, SessionState& next);
void apply(const ClearTarget& c, SessionState& next);
void apply(const SetLimits& c, SessionState& next);
void apply(const ResetJoint& c, SessionState& next);
void apply(const ResetPose& c, SessionState& next);
void apply(const MirrorPose& c, SessionState& next);
// Soles that were pinned are released where the pose lifts them; other joints take their targets along.
void apply(const ApplyPose& command, SessionState& state);
// Pinned joints have priority over the tasks.
void apply(const ApplyTasks& command, SessionState& state);

// Those that a command names in `joint` and `with`.
std::vector<Index> jointsOf(const SessionState& state, const std::string& joint, const std::vector<std::string>& with);

// Those of the targets for which `which` says so go where their joints are now.
void followPose(SessionState& state, const std::function<bool(const PinnedTarget&)>& which);

// Pins the feet that are planted in this pose, where limbs follow by themselves.
void holdStandingFeet(SessionState& state);

// The pose becomes that of the chosen clip at its moment.
void show(SessionState& state);

}  // namespace limber
