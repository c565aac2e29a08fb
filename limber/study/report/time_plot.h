// Time against quality, as a drawing.
#pragma once

#include <string>

#include "limber/study/ranking/method_ranking.h"

namespace limber {

// SVG for a page: a point for each method that has a time and a finite median, with its rank; time is logarithmic, and
// the better side is up. Empty where fewer than two methods have both, and for time itself.
std::string timePlot(const Ranking& ranking);

}  // namespace limber
