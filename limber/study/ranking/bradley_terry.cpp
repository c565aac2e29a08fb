#include "limber/study/ranking/bradley_terry.h"

#include <algorithm>
#include <cmath>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr int kMaxSteps = 10000;
constexpr int kMaxCenterings = 100;
constexpr double kSettled = 1e-9;  // largest change of a strength, of itself

std::vector<double> winsOf(std::size_t players, std::span<const PairScore> scores) {
  std::vector<double> wins(players, kImaginedGames);
  for (const PairScore& score : scores) {
    wins[score.first] += score.firstWins;
    wins[score.second] += score.secondWins;
  }
  return wins;
}

// The scale that the prior wants, by Newton's method on its logarithm: what was played says nothing of it, and so it
// would settle last, the later the more was played.
void center(std::span<double> strengths) {
  for (int step = 0; step < kMaxCenterings; ++step) {
    double excess = 0, slope = 0;
    for (const double strength : strengths) {
      const double chance = strength / (strength + 1);
      excess += chance - 0.5;
      slope += chance * (1 - chance);
    }
    const double shift = std::clamp(-excess / slope, -1.0, 1.0);
    for (double& strength : strengths) strength *= std::exp(shift);
    if (std::abs(shift) < kSettled) return;
  }
}

}  // namespace

std::vector<double> bradleyTerryStrengths(std::size_t players, std::span<const PairScore> scores) {
  for (const PairScore& score : scores) {
    if (score.first >= players || score.second >= players || score.first == score.second)
      throw Error(ErrorCode::kBadArgument, "a pair is not of two of the players");
  }
  const std::vector<double> wins = winsOf(players, scores);
  std::vector<double> strengths(players, 1.0), before, played(players);
  double change = 1;
  for (int step = 0; step < kMaxSteps && change > kSettled; ++step) {
    for (std::size_t i = 0; i < players; ++i) played[i] = 2 * kImaginedGames / (strengths[i] + 1);
    for (const PairScore& score : scores) {
      const double games = (score.firstWins + score.secondWins) / (strengths[score.first] + strengths[score.second]);
      played[score.first] += games;
      played[score.second] += games;
    }
    before = strengths;
    for (std::size_t i = 0; i < players; ++i) strengths[i] = wins[i] / played[i];
    center(strengths);
    change = 0;
    for (std::size_t i = 0; i < players; ++i) {
      change = std::max(change, std::abs(strengths[i] - before[i]) / before[i]);
    }
  }
  return strengths;
}

}  // namespace limber
