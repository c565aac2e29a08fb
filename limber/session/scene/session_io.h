// A session's state out of a document, and into one.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "limber/document/mesh/mesh_export.h"
#include "limber/session/scene/session_file.h"
#include "limber/session/session.h"

namespace limber {

// The state right after opening: as it was saved, else with the model's own rig, else with a new one; a prop's has one
// joint.
SessionState startState(std::shared_ptr<const Asset> source, const std::optional<SavedSession>& saved, bool asProp,
                        Progress& progress);

// The rigged model with its clips, its joints standing in the pose.
Asset posedDocument(const SessionState& state);
// The posed surface alone, as the deformer bends it.
ExportMesh posedMesh(const SessionState& state);
// `asset`: with the materials of a USDZ; its collectGeometry() has the mesh's vertices in their order.
Bytes encodeMesh(const ExportMesh& mesh, const Asset& asset, ExportFormat format);

// Session::exportModel and saveSession.
Bytes exportState(const SessionState& state, ExportFormat format);
Bytes savedState(const SessionState& state);

// What both a state's beginning and its commands do.
Index requireJoint(const SessionState& state, const std::string& name);  // throws Error kBadArgument
void setLimits(SessionState& state, const std::string& text);
// The pose is one that was set by hand (SessionState::authoredPose).
void authored(SessionState& state);

}  // namespace limber
