// Which of many candidate poses of each limb go together.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limber/rigging/figure/limb_finder.h"

namespace limber {

using LimbCandidates = std::array<std::vector<LimbFinder::Candidate>, kFigureLimbs>;

// One of each limb's candidates, by its number, so that the sum of their matches less their overlaps comes near the
// largest: starting with the first ones, pairs are exchanged as long as that is an improvement.
//
// candidates  best first, at least one for each limb
// Cost: the overlap of each pair of candidates of two limbs, once.
std::array<std::size_t, kFigureLimbs> chooseLimbs(const Figure& figure, const LimbCandidates& candidates);

}  // namespace limber
