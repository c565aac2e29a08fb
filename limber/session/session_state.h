// A session's state in JSON, for a front end to show.
#pragma once

#include "limber/asset/asset.h"
#include "limber/session/session.h"

namespace limber {

// {"name", "vertices", "triangles", "box": {"min", "max"}, "own_rig", "rigger", "skinning", "most_handles",
//  "suggestions": [counts, best first], "joints": [{"name", "parent" (-1: none), "radius", "rest": position}],
//  "ik", "limited", "targets": [{"joint": index, "position"}], "dragged" (a joint's index or null), "posed",
//  "undo", "redo" (command names or null), "warnings": [{"kind", "message", "where", "count"}]}
// Throws Error kBadArgument while nothing is open.
Json sessionState(const Session& session);

}  // namespace limber
