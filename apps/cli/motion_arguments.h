// The options that say what files of motions leave open.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "limber/document/clip/motion_io.h"

namespace limber::cli {

struct MotionArguments {
  std::string up = "auto", body;

  void addTo(CLI::App& command);
  // Reads the body. Throws Error where it cannot be read or is none.
  MotionOptions options() const;
};

}  // namespace limber::cli
