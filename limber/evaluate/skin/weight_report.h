// Comparisons of weights as JSON and as text.
#pragma once

#include <string>

#include "limber/document/asset.h"
#include "limber/evaluate/skin/weight_metrics.h"

namespace limber {

// Every field of the comparison by its name.
Json toJson(const WeightComparison& comparison);

// A few lines for a terminal.
std::string toText(const WeightComparison& comparison);

}  // namespace limber
