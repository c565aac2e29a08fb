// Commands that give the model another rig, another rest pose or another deformer.
#pragma once

#include <memory>

#include "limber/session/session.h"

namespace limber {

void apply(const SetHandles& c, SessionState& next, Progress& progress);
void apply(const ChooseMethods& c, SessionState& next, Progress& progress);
void apply(const PinJoint& c, SessionState& next, Progress& progress);
void apply(const UnpinJoint& c, SessionState& next, Progress& progress);
void apply(const RigFromAnimation& c, SessionState& next, Progress& progress);
void apply(const SetRestPose& c, SessionState& next);
void apply(const SetDeformer& c, SessionState& next);

// Targets and limits speak of joints, so they go with the rig that had those; clips come along.
void setRig(SessionState& state, std::shared_ptr<const RiggedModel> rig, Progress& progress);

}  // namespace limber
