// Errors that name a place in a document ("meshes[0].primitives[2].indices").
#pragma once

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/types.h"

namespace limber {

[[noreturn]] inline void failAt(std::string place, std::string message) {
  throw Error(ErrorCode::kBadData, std::move(message), std::move(place));
}

inline std::string accessorPlace(Index accessor) {
  return fmt::format("accessors[{}]", accessor);
}

// Fails unless the number, if there is one, is one of `count` elements. `place()` makes the path of what refers to it.
template <typename Place>
void requireElement(std::optional<Index> number, std::size_t count, const Place& place) {
  if (!number || *number < count) return;
  failAt(place(), count == 0 ? fmt::format("is {}, but there is no such element", *number)
                             : fmt::format("is {}, but the last one is {}", *number, count - 1));
}

}  // namespace limber
