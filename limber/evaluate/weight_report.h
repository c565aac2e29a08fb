// Comparisons of weights as JSON and as text.
#pragma once

#include <string>

#include "limber/asset/asset.h"
#include "limber/evaluate/weight_metrics.h"

namespace limber {

// Every field of the comparison by its name.
Json toJson(const WeightComparison& comparison);

// A few lines for a terminal.
std::string toText(const WeightComparison& comparison);

}  // namespace limber
