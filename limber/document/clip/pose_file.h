// A pose as a file (.pose.json), to keep and to exchange.
#pragma once

#include <string>
#include <string_view>

#include "limber/skeleton/portable_pose.h"

namespace limber {

inline constexpr std::string_view kPoseFileEnding = ".pose.json";

// {"limber_pose": 1, "name": "wave", "joints": [{"name": "j0", "bone": "hips", "parent": "root", "rest":
// {"translation": [0, 1, 0], "rotation": [x, y, z, w], "scale": [1, 1, 1]}, "local": {...}}]}: parents before children;
// bone: what the file that the pose is from declares the joint to be, if anything (Joint::declaredBone); no parent: a
// root; parts of a transform that are not there are those of the identity, and no "local": as at rest. Numbers are
// written so that reading gives them back bit for bit.
std::string poseToJson(const PortablePose& pose);

// Throws Error kBadData that names the entry: not JSON, another version, a key or bone that is not known, a parent
// that does not come before, a name twice, numbers that make no transform; kLimit for more than 4 MB or 2000 joints.
PortablePose poseFromJson(std::string_view text);

}  // namespace limber
