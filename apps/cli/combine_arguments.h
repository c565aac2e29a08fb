// The options that make one motion of several.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "limber/actions/motion/combine_motions.h"

namespace limber::cli {

struct CombineArguments {
  void addTo(CLI::App& command);
  // None where the motions stay apart. Throws CLI::ValidationError where the options and the number of motions do not
  // go together, or go against `byProgram`: a program of the user's retargets.
  std::optional<CombineOptions> options(std::size_t motions, bool byProgram) const;

 private:
  std::string blend_;
  std::optional<double> crossfade_;
  bool sequence_ = false;
};

}  // namespace limber::cli
