// Models that limber makes itself, so that everything can be tried with no download.
#pragma once

#include <span>
#include <string_view>

#include "limber/document/asset.h"

namespace limber {

struct SampleModel {
  std::string_view name;     // "quadruped"
  std::string_view summary;  // one line for --help
  Asset (*make)();
};

std::span<const SampleModel> sampleModels();

// The model of that name, in metres, feet on y = 0, facing +Z, exactly symmetric in x; every piece watertight; the same
// bytes each time. Throws Error kBadArgument that lists the names there are. Cost: a fraction of a second.
Asset makeSample(std::string_view name);

}  // namespace limber
