// The deformers, as help lists them.
#pragma once

#include <string>

#include <fmt/format.h>

#include "limber/deform/deformer.h"

namespace limber::cli {

inline std::string deformerList() {
  std::string text = "Deformers:\n";
  for (const Deformer& deformer : deformers()) text += fmt::format("  {:<20}{}\n", deformer.name, deformer.summary);
  return text;
}

}  // namespace limber::cli
