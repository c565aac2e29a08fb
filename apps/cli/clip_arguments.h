// The options by which commands make finished clips ready for an engine.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "command.h"
#include "limber/actions/motion/clip_edits.h"

namespace limber::cli {

struct ClipArguments {
  ClipEdits edits;

  void addTo(CLI::App& command);
  // Throws CLI::ValidationError where an option does nothing without another that is not given.
  void check() const;
  void tell(const std::vector<ClipEditReport>& reports, const Account& account) const;

 private:
  std::string rootJoint_;
  const CLI::App* command_ = nullptr;
};

}  // namespace limber::cli
