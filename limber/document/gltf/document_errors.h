// Errors with a path in a document ("meshes[0].primitives[2].indices").
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/types.h"

namespace limber {

[[noreturn]] inline void failAt(std::string location, std::string message) {
  throw Error(ErrorCode::kBadData, std::move(message), std::move(location));
}

inline std::string accessorLocation(Index accessor) {
  return fmt::format("accessors[{}]", accessor);
}

// Fails unless the number, if there is one, is one of `count` elements. `location()` makes the path of what refers to
// it.
template <typename Location>
void requireElement(std::optional<Index> number, std::size_t count, const Location& location) {
  if (!number || *number < count) return;
  failAt(location(), count == 0 ? fmt::format("is {}, but there is no such element", *number)
                                : fmt::format("is {}, but the last one is {}", *number, count - 1));
}

}  // namespace limber
