#include "limber/study/ranking/bradley_terry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "limber/core/error.h"
#include "limber/core/random.h"

namespace limber {
namespace {

double logPosterior(std::span<const PairScore> scores, std::span<const double> logStrengths) {
  const auto logWin = [](double gap) { return -std::log1p(std::exp(-gap)); };
  double sum = 0;
  for (const PairScore& score : scores) {
    const double gap = logStrengths[score.first] - logStrengths[score.second];
    sum += score.firstWins * logWin(gap) + score.secondWins * logWin(-gap);
  }
  for (const double one : logStrengths) sum += logWin(one) + logWin(-one);
  return sum;
}

std::vector<PairScore> tournament(std::size_t players, std::uint64_t seed) {
  Random random(seed);
  std::vector<PairScore> scores;
  for (std::size_t i = 0; i < players; ++i) {
    for (std::size_t j = i + 1; j < players; ++j) {
      const double first = 0.5 * static_cast<double>(random.below(20));
      const double second = 0.5 * static_cast<double>(random.below(20));
      scores.push_back({i, j, first, second});
    }
  }
  return scores;
}

// Without a prior, log odds of what was won; the prior fades.
TEST(BradleyTerry, TwoPlayersAreAsFarApartAsTheirLogOdds) {
  const PairScore score[] = {{0, 1, 3e6, 1e6}};
  const std::vector<double> strengths = bradleyTerryStrengths(2, score);
  EXPECT_NEAR(std::log(strengths[0] / strengths[1]), std::log(3.0), 1e-5);
  EXPECT_NEAR(strengths[0] * strengths[1], 1, 1e-6);
}

// By symmetry s and 1 / s, where 3 + 1 = 4 s^2 / (s^2 + 1) + 2 s / (s + 1), found by halving.
TEST(BradleyTerry, TwoPlayersOfFewGamesAreDrawnToTheMiddle) {
  const PairScore score[] = {{0, 1, 3, 1}};
  double low = 1, high = 3;
  for (int i = 0; i < 100; ++i) {
    const double s = 0.5 * (low + high);
    (4 * s * s / (s * s + 1) + 2 * s / (s + 1) < 4 ? low : high) = s;
  }
  EXPECT_NEAR(bradleyTerryStrengths(2, score)[0], low, 1e-7);
  EXPECT_LT(low * low, 3);
}

TEST(BradleyTerry, ThreePlayersAreTheMostLikely) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const std::vector<PairScore> scores = tournament(3, seed);
    // A grid that closes in on its best point; the logarithm of the posterior is concave.
    std::vector<double> best = {0, 0, 0};
    for (double step = 1; step > 1e-7; step *= 0.5) {
      for (bool isBetter = true; isBetter;) {
        const std::vector<double> middle = best;
        double most = logPosterior(scores, middle);
        isBetter = false;
        for (int at = 0; at < 27; ++at) {
          const std::vector<double> tried = {middle[0] + step * (at % 3 - 1), middle[1] + step * (at / 3 % 3 - 1),
                                             middle[2] + step * (at / 9 - 1)};
          if (const double value = logPosterior(scores, tried); value > most) {
            most = value;
            best = tried;
            isBetter = true;
          }
        }
      }
    }
    const std::vector<double> strengths = bradleyTerryStrengths(3, scores);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(std::log(strengths[i]), best[i], 1e-5) << "seed " << seed;
  }
}

TEST(BradleyTerry, ChancesAgainstTheMiddleAreAHalfOnAverage) {
  for (const std::size_t players : {2u, 5u, 9u}) {
    double sum = 0;
    for (const double s : bradleyTerryStrengths(players, tournament(players, players))) sum += s / (s + 1);
    EXPECT_NEAR(sum / static_cast<double>(players), 0.5, 1e-7);
  }
}

TEST(BradleyTerry, NeitherOrderNorNamesMatter) {
  std::vector<PairScore> scores = tournament(6, 7);
  const std::vector<double> strengths = bradleyTerryStrengths(6, scores);
  std::reverse(scores.begin(), scores.end());
  for (PairScore& score : scores) {
    score = {5 - score.second, 5 - score.first, score.secondWins, score.firstWins};
  }
  const std::vector<double> turned = bradleyTerryStrengths(6, scores);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(turned[5 - i], strengths[i], 1e-7 * strengths[i]);
}

TEST(BradleyTerry, UndefeatedPlayersAreFiniteAndRiseWithTheirGames) {
  double before = 1;
  for (const double games : {1.0, 4.0, 16.0, 256.0}) {
    const PairScore score[] = {{0, 1, games, 0}};
    const std::vector<double> strengths = bradleyTerryStrengths(2, score);
    EXPECT_GT(strengths[0], before);
    EXPECT_TRUE(std::isfinite(strengths[0]));
    EXPECT_GT(strengths[1], 0);
    before = strengths[0];
  }
}

// Two groups that never met, and one who met nobody.
TEST(BradleyTerry, GroupsThatNeverMetAreEachAroundTheMiddle) {
  const PairScore scores[] = {{0, 1, 8, 2}, {2, 3, 8, 2}};
  const std::vector<double> strengths = bradleyTerryStrengths(5, scores);
  EXPECT_NEAR(strengths[0], strengths[2], 1e-9);
  EXPECT_NEAR(strengths[1], strengths[3], 1e-9);
  EXPECT_NEAR(strengths[4], 1, 1e-8);
  EXPECT_GT(strengths[0], 1);
}

TEST(BradleyTerry, RefusesPairsOfNobody) {
  const PairScore outside[] = {{0, 2, 1, 1}}, itself[] = {{1, 1, 1, 1}};
  EXPECT_THROW(bradleyTerryStrengths(2, outside), Error);
  EXPECT_THROW(bradleyTerryStrengths(2, itself), Error);
  EXPECT_TRUE(bradleyTerryStrengths(0, {}).empty());
}

}  // namespace
}  // namespace limber
