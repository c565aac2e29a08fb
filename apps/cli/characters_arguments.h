// The options by which motions go onto a list of characters.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "limber/crowd/retarget_characters.h"

namespace limber::cli {

struct CharactersArguments {
  std::string list, format = "glb";
  bool isSeparate = false;

  void addTo(CLI::App& command);
  bool isGiven() const { return !list.empty(); }
  // Of the list, without motions and folder. Throws Error as readCharacterList does.
  CharactersJob job() const;
  // Does it and tells of it. Throws Error where not everything went well.
  void run(const CharactersJob& job, bool isQuiet) const;
};

}  // namespace limber::cli
