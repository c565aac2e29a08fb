// Which of many ways to hold each limb go together.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "limber/rigging/figure/limb_finder.h"

namespace limber {

using LimbCandidates = std::array<std::vector<LimbFinder::Candidate>, kFigureLimbs>;

// One of each limb's candidates, by its number, so that their matches less what they share come near the most: from the
// first ones pairs are exchanged, as long as that is for the better.
//
// candidates  best first, at least one for each limb
// Cost: what each pair of candidates of two limbs shares, once.
std::array<std::size_t, kFigureLimbs> chooseLimbs(const Figure& figure, const LimbCandidates& candidates);

}  // namespace limber
