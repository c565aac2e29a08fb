// How an FBX file is written, as options of commands that write one.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "limber/actions/export/write_model.h"

namespace limber::cli {

struct FbxArguments {
  std::string unit, up = "y";

  void addTo(CLI::App& command) {
    command.add_option("--fbx-unit", unit, "the unit of an FBX to write: cm or m (default: as the target expects)")
        ->check(CLI::IsMember({"cm", "m"}))
        ->type_name("UNIT");
    command.add_option("--fbx-up", up, "which axis of an FBX to write points up")
        ->check(CLI::IsMember({"y", "z"}))
        ->type_name("AXIS")
        ->capture_default_str();
  }

  void setIn(WriteModelOptions& options) const {
    if (!unit.empty()) options.fbxUnit = unit == "m" ? FbxUnit::kMetre : FbxUnit::kCentimetre;
    options.fbxUp = up == "z" ? FbxUpAxis::kZ : FbxUpAxis::kY;
  }
};

}  // namespace limber::cli
