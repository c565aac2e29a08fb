// A scene's state in JSON, for a front end to show.
#pragma once

#include "limber/session/scene/scene.h"

namespace limber {

// The state of the chosen member's session (session_state.h) with "undo" and "redo" of the scene, and
// {"member": the chosen one's index, "members": [{"name", "source": the file's name, "joints": [{"name", "part" (as of
// the
//  session's)}], "placement": {"position", "turn", "scale"} in the scene as it is now, "attached": null or {"to":
//  index, "joint"}, "clip": name or null, "duration": seconds of it, "box": {"min", "max"} of the bound surface, in its
//  own space}]}
// Throws Error kBadArgument while nothing is open.
Json sceneState(const SessionScene& scene);

}  // namespace limber
