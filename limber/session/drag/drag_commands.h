// Commands that move joints as a drag does, and what they have in common with drags under a pointer.
#pragma once

#include <string>
#include <vector>

#include "limber/session/session.h"

namespace limber {

void apply(const PlaceJoint& c, SessionState& next);
void apply(const SetTurn& c, SessionState& next);
void apply(const SetScale& c, SessionState& next);

// What a drag of `joint` works on, with others that do the same and, mirrored, with their mirror images.
DragScene dragSceneOf(const SessionState& now, Index joint, const std::vector<std::string>& with, bool mirrored);

// Throws Error where the clip that is shown holds no scale.
void requireScalable(const SessionState& now);

// Moves the targets of pinned joints to where the drag moved these.
void letGo(SessionState& next, const Drag& drag);

}  // namespace limber
