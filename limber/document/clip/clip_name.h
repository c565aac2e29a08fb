// Which of the clips of a file a name means.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "limber/core/types.h"

namespace limber {

// The clip of that name: the first whose full name it is, else the first whose name ends with it after the last '|'
// (Blender's exporters prefix the armature's name). Throws Error kBadArgument that lists the names, with `where`.
Index clipNamed(std::span<const std::string> names, std::string_view name, std::string_view where);

}  // namespace limber
