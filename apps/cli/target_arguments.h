// The option that says which program a model is written for.
#pragma once

#include <string>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "limber/actions/export/engine_target.h"

namespace limber::cli {

struct TargetArguments {
  std::string target = std::string(kPlainTarget);

  void addTo(CLI::App& command) {
    command.add_option("--target", target, "joints' names, root and axes as another program expects them, see below")
        ->type_name("NAME")
        ->capture_default_str();
  }

  // Throws Error kBadArgument for a name that there is not.
  void check() const { findTarget(target); }

  // For the footer of a command's help.
  static std::string list() {
    std::string text = "Targets:\n";
    for (const EngineTarget& each : engineTargets()) text += fmt::format("  {:<20}{}\n", each.name, each.summary);
    return text;
  }
};

}  // namespace limber::cli
