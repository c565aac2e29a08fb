// The options by which commands find programs of the user's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "limber/adapters/adapter.h"

namespace limber::cli {

struct AdapterArguments {
  std::vector<std::string> files, folders;
  std::optional<std::uint64_t> seed;

  void addTo(CLI::App& command);
  void addFolderTo(CLI::App& command);  // that option alone
  // Those given, then the usual one.
  std::vector<std::filesystem::path> allFolders() const;

  // None where the name is that of one of limber's own methods (which `known` lists). Throws Error kBadArgument where
  // it is no adapter's either, or the adapter is of another kind: "no rigger is called 'x'" where `what` is "rigger".
  std::optional<Adapter> programFor(std::string_view name, std::string_view what, AdapterKind kind,
                                    const std::vector<std::string>& known) const;
  // Throws CLI::ValidationError where a file given is the adapter of none of the methods asked for, or there is a seed
  // and no program.
  void refuseUnused(const std::vector<std::string>& methods, bool hasProgram) const;
};

}  // namespace limber::cli
