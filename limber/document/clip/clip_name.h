// Which of the clips of a file a name means.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "limber/core/types.h"

namespace limber {

// The clip of that name: the first that is called so in full, else the first behind whose last '|' it stands (Blender's
// exporters put the armature's name before). Throws Error kBadArgument that lists the names, with `where`.
Index clipNamed(std::span<const std::string> names, std::string_view name, std::string_view where);

}  // namespace limber
