// Names of files and of methods.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "limber/core/error.h"

namespace limber {

// A to Z become a to z; every other byte stays as it is.
std::string lowerCase(std::string_view text);

// The file name's last dot and what follows it, in lower case: ".glb". Empty where there is no dot.
std::string lowerExtension(const std::filesystem::path& path);

// The entry of a table whose member `name` is `name`. Throws Error kBadArgument: "no <what> is called '<name>'", with
// the names that there are as the remedy.
template <typename Table>
const auto& findByName(const Table& table, std::string_view what, std::string_view name) {
  std::string known;
  for (const auto& entry : table) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error(ErrorCode::kBadArgument, "no " + std::string(what) + " is called '" + std::string(name) + "'", {},
              "there are: " + known);
}

}  // namespace limber
