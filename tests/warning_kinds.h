// What tests ask of warnings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"

namespace limber::testing {

inline std::vector<std::string> warningKinds(const Warnings& warnings) {
  std::vector<std::string> kinds;
  for (const Warning& warning : warnings.items()) kinds.push_back(warning.kind);
  return kinds;
}

// How often the warning was counted; 0 where there is none of that kind.
inline std::size_t countOf(const Warnings& warnings, std::string_view kind) {
  for (const Warning& warning : warnings.items()) {
    if (warning.kind == kind) return warning.count;
  }
  return 0;
}

}  // namespace limber::testing
