// A session's state out of a document, and into one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "limber/session/session.h"
#include "limber/session/session_file.h"

namespace limber {

// The state right after opening: as it was saved, else with the model's own rig, else with a new one.
SessionState startState(std::shared_ptr<const Asset> source, const std::optional<SavedSession>& saved,
                        Progress& progress);

// Session::exportModel and saveSession.
Bytes exportState(const SessionState& state, ExportFormat format);
Bytes savedState(const SessionState& state);

// What both a state's beginning and its commands do.
Index requireJoint(const SessionState& state, const std::string& name);  // throws Error kBadArgument
void setLimits(SessionState& state, const std::string& text);
// The pose is one that was set by hand (SessionState::authoredPose).
void authored(SessionState& state);

}  // namespace limber
