// What somebody wants of a pose, in words: joints turned, scaled, moved and reached, and tasks. From the command line or a JSON
// file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/actions/pose/pose_tasks.h"
#include "limber/core/types.h"

namespace limber {

// All in world space: metres, and the world's axes, not the joint's own. `where` says what an edit was read from,
// "poses.json: poses[0].turn[1]" or the text itself in quotes: for errors found later, may be empty.
struct JointTurn {
  std::string joint;
  Vec3 axis = Vec3::UnitY();  // unit vector
  double degrees = 0;         // counter-clockwise seen from the axis' tip; the joint and what hangs on it turn
  std::string where = {};
};

struct JointScale {
  std::string joint;
  double factor = 1;  // above 0, along all axes; its surface and its children grow
  std::string where = {};
};

struct JointMove {
  std::string joint;
  Vec3 offset = Vec3::Zero();  // the joint and what hangs on it move
  std::string where = {};
};

// Inverse kinematics: the joint's origin goes to the target, the joints above it turn.
struct JointReach {
  std::string joint;
  Vec3 target = Vec3::Zero();
  std::optional<Vec3> pole;         // the point to which the middle of the limb bends
  std::optional<std::string> base;  // the highest joint that turns
  std::string where = {};
};

// Carried out in this order: all turns as listed, all scales, all moves as listed, all reaches at once (editPose), then
// all tasks at once (applyTasks).
struct PoseEdits {
  std::vector<JointTurn> turns;
  std::vector<JointScale> scales;
  std::vector<JointMove> moves;
  std::vector<JointReach> reaches;
  std::vector<TaskEdit> tasks = {};
};

// "head=y:30" or "head=x:10,y:30": axes x, y, z; degrees. Throws Error kBadArgument that quotes the text.
std::vector<JointTurn> parseTurn(std::string_view text);
// "head=1.5"
JointScale parseScale(std::string_view text);
// "handle_07=0,0.1,0"
JointMove parseMove(std::string_view text);
JointReach parseReach(std::string_view text);
// "hand.L=0,1,2" sets the pole, "hand.L=chest" the base of the reach of that joint. Throws Error kBadArgument where no
// reach of that joint is there.
void parsePole(std::string_view text, PoseEdits& edits);
void parseBase(std::string_view text, PoseEdits& edits);

struct NamedPose {
  std::string name;
  PoseEdits edits;
};

// {"poses": [{"name": "wave",
//             "turn":  [{"joint": "head", "axis": [0, 1, 0], "degrees": 30}],
//             "scale": [{"joint": "head", "factor": 1.5}],
//             "move":  [{"joint": "hips", "offset": [0, -0.1, 0]}],
//             "reach": [{"joint": "hand.L", "target": [0.4, 1.2, 0.3], "pole": [0, 1, -1], "base": "chest"}],
//             "tasks": [{"kind": "look-at", "joint": "head", "target": [0, 1.6, 2], "weight": 2, "priority": 1}]}]}
// Schema: docs/poses.schema.json.
// Every list may be absent; other keys, keys that stand twice and two poses of one name are refused. Throws Error
// kBadData with the file and the entry: "poses.json: poses[0].reach[1].target".
//
// file  what the text was read from, for errors; may be empty
std::vector<NamedPose> parsePoses(std::string_view json, std::string_view file = {});

}  // namespace limber
