#include "limber/document/clip/clip_name.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

Index clipNamed(std::span<const std::string> names, std::string_view name, std::string_view where) {
  auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    found = std::find_if(names.begin(), names.end(),
                         [&](std::string_view full) { return full.substr(full.rfind('|') + 1) == name; });
  }
  if (found != names.end()) return static_cast<Index>(found - names.begin());
  throw Error(ErrorCode::kBadArgument, fmt::format("there is no clip called '{}'", name), std::string(where),
              names.empty() ? "the file has no clip" : fmt::format("there are: {}", fmt::join(names, ", ")));
}

}  // namespace limber
