// A session's state in JSON, for a front end to show.
#pragma once

#include "limber/document/asset.h"
#include "limber/session/session.h"

namespace limber {

// {"name", "vertices", "triangles", "box": {"min", "max"}, "own_rig", "rigger", "skinning", "most_handles",
//  "suggestions": [counts, best first], "joints": [{"name", "parent" (-1: none), "part" ("left foot",
//  null where doubtful), "color" (of that part: hue, saturation, value, 0 to 1), "radius", "rest": position}],
//  "motions": [{"name", "joints": [{"name", "parent"}], "clips": [{"name", "duration"}]}],
//  "clips": [{"name", "duration", "recorded" (its keys are those of the layer on it), "keys": [seconds],
//  "joint_keys": [{"joint": index, "seconds": [...]}] (the same for each joint that has any), "interpolation",
//  "source": null or {"motion", "clip", "method", "reach", "contacts"},
//  "sequence": null or {"seconds" (that they overlap), "clips": [{"clip", "from", "to"}]} (JoinClips),
//  "feet": of the motion, with their plants: [{"foot": its joint, "part", "planted": [[from, to] seconds],
//  "edited": whether the user changed them}]}],
//  "clip": the chosen one's index or null,
//  "seconds",
//  "snap": {"degrees", "step" (metres)} (snap.h),
//  "match": of the chosen clip, where it is from a motion: [{"part", "source": [joints], "target": [joints],
//  "confidence", "by"}],
//  "limits": {joint's name: limit} as in a limits file,
//  "limit_outlines": [{"joint": index, "length": metres, "closed", "rim": [directions]}] (limit_outline.h), in the
//  world with its parent in rest pose,
//  "solver", "deformer", "ik", "limited", "targets": [{"joint": index, "position"}],
//  "tasks": [{"task", "outcome" (in words), "met"}] (ApplyTasks), "pins": [{"joint": name, "position"}],
//  "doubts": [indices of joints whose pins would settle most (AutoRig)], "locked": [indices of joints whose weights
//  are], "edited_rig" (weights or joints, by hand), "gaps": null or, of a rig that came from another model,
//  where its surface stays apart from this one (toJson), "animated" (the file has animations), "dragged" (a joint's
//  index or null), "posed", "undo", "redo" (command names or null), "warnings": [{"kind", "message", "where",
//  "count"}]}
// Throws Error kBadArgument while nothing is open.
Json sessionState(const Session& session);

// What a joint is of the body ("left foot"), where that is sure enough to be said; else empty.
std::string sureLabel(const RiggedModel& rig, Index joint);

}  // namespace limber
