// Strengths out of comparisons of two at a time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limber {

// All that two players have played against each other; a tie is half a win of each.
struct PairScore {
  std::size_t first = 0, second = 0;  // players, not the same
  double firstWins = 0, secondWins = 0;
};

// A win and a loss of each player against an imagined one of strength 1: a logistic prior of the logarithm, as large as
// the model's own curve (Davidson, Solomon 1973; Newman 2023). With it every player has a strength, one too that won
// or lost all of its games or met none of the others; its pull fades as games are played.
inline constexpr double kImaginedGames = 1;

// The Bradley-Terry model: the first wins with the probability s_first / (s_first + s_second). The strengths that make
// prior and scores the most likely, by minorisation-maximisation (Hunter 2004, eq. 3), until none changes by more than
// 1e-9 of itself. The mean of s / (s + 1), the chance of winning against the imagined player, is 1/2.
// players x 1. Independent of the order of the pairs but for rounding. Linear in the pairs in each of at most 10000
// steps.
std::vector<double> bradleyTerryStrengths(std::size_t players, std::span<const PairScore> scores);

}  // namespace limber
