// A user's skeleton, read from a file to serve as a template.
#pragma once

#include <filesystem>
#include <string_view>

#include "limber/core/file/file.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

// From JSON: {"joints": [{"name": "hips", "position": [0, 1, 0]}, {"name": "spine", "parent": "hips", "position":
// ...}]}, positions in one space, +Y up and +Z front; joints may stand in any order. Throws Error kBadData naming the
// joint: a name missing or twice, an unknown parent, a cycle, no joint, a position that is no three finite numbers.
Skeleton parseTemplate(std::string_view json);

// From a .json as above, or the skeleton in rest pose of any other file: a model with a rig, or a motion (readMotion).
Skeleton readTemplateFile(const std::filesystem::path& path);
Skeleton readTemplateFile(ByteSpan bytes, std::string_view name);

}  // namespace limber
