#include "limber/study/ranking/paired_statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "limber/core/random.h"

namespace limber {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Every choice of signs, with mean ranks counted pair by pair.
double signedRankByEnumeration(const std::vector<double>& d) {
  const std::size_t n = d.size();
  std::vector<double> rank(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      rank[i] += std::abs(d[j]) < std::abs(d[i]) ? 1 : std::abs(d[j]) == std::abs(d[i]) ? 0.5 : 0;
    }
    rank[i] += 0.5;
  }
  const auto sumOf = [&](auto isPositive) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += isPositive(i) ? rank[i] : 0;
    return sum;
  };
  const double middle = sumOf([](std::size_t) { return true; }) / 2;
  const double off = std::abs(sumOf([&](std::size_t i) { return d[i] > 0; }) - middle);
  std::size_t asFar = 0;
  const std::size_t choices = std::size_t{1} << n;
  for (std::size_t signs = 0; signs < choices; ++signs) {
    if (std::abs(sumOf([&](std::size_t i) { return (signs >> i & 1) != 0; }) - middle) >= off) ++asFar;
  }
  return std::min(1.0, static_cast<double>(asFar) / static_cast<double>(choices));
}

TEST(SignedRank, IsWhatAllChoicesOfSignsGive) {
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> d(1 + random.below(11));
    for (double& value : d) {
      value = std::round(4 * random.uniform(-1, 1.5));  // with ties
      if (value == 0) value = 0.5;
    }
    EXPECT_NEAR(signedRankP(d), signedRankByEnumeration(d), 1e-12) << trial;
  }
}

// Hollander, Wolfe: nine patients, W+ = 5: 0.0391 in the books' tables (2 * 10 / 512).
TEST(SignedRank, IsThatOfTheTables) {
  const std::vector<double> x = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::vector<double> y = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> d;
  for (std::size_t i = 0; i < x.size(); ++i) d.push_back(x[i] - y[i]);
  EXPECT_NEAR(signedRankP(d), 2 * 10 / 512.0, 1e-12);
}

TEST(SignedRank, ZerosAndPairsOfFailuresTellNothing) {
  EXPECT_EQ(signedRankP({}), 1);
  const std::vector<double> nothing = {0, 0, kInfinity - kInfinity};
  EXPECT_EQ(signedRankP(nothing), 1);
  const std::vector<double> some = {1, 2, 3, 4, 5, 6}, more = {0, 1, 2, 3, 4, 5, kInfinity - kInfinity, 6};
  EXPECT_EQ(signedRankP(some), signedRankP(more));
  const std::vector<double> failures = {1, 2, 3, 4, 5, kInfinity};
  EXPECT_EQ(signedRankP(failures), signedRankP(some));
}

TEST(SignedRank, TheNormalTailGoesOnWhereTheExactOneEnds) {
  Random random(8);
  std::vector<double> d(201);
  for (double& value : d) value = random.uniform(-1, 1.25);
  const double beyond = signedRankP(d);
  d.pop_back();
  EXPECT_NEAR(beyond, signedRankP(d), 0.2 * beyond);
  EXPECT_LT(beyond, 0.1);
}

TEST(BootstrapMedian, HoldsTheMedianBetweenItsEnds) {
  const std::vector<double> one = {7};
  EXPECT_EQ(bootstrapMedian(one).low, 7);
  EXPECT_EQ(bootstrapMedian(one).high, 7);
  std::vector<double> many(101);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  const MedianInterval interval = bootstrapMedian(many);
  EXPECT_EQ(interval.median, 50);
  // The order statistics that hold it with 95 % by the binomial distribution: 50 -+ 1.96 sqrt(101) / 2.
  EXPECT_NEAR(interval.low, 40.2, 3);
  EXPECT_NEAR(interval.high, 59.8, 3);
}

TEST(BootstrapMedian, CoversTheTruthAboutAsOftenAsItSays) {
  Random random(5);
  int covered = 0;
  constexpr int kTrials = 100;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> values(25);
    for (double& value : values) value = random.uniform();
    const MedianInterval interval = bootstrapMedian(values);
    covered += interval.low <= 0.5 && 0.5 <= interval.high ? 1 : 0;
  }
  EXPECT_GE(covered, 87);  // 95 expected, deviation 2.2
}

TEST(BootstrapMedian, FailuresAreTheWorst) {
  const std::vector<double> values = {1, kInfinity, 2, kInfinity, 3};
  EXPECT_EQ(bootstrapMedian(values).median, 3);
  EXPECT_EQ(bootstrapMedian(values).high, kInfinity);
}

TEST(Holm, CorrectsStepByStep) {
  const std::vector<double> p = {0.01, 0.04, 0.03, 0.005};
  EXPECT_THAT(holmCorrected(p), ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12), DoubleNear(0.06, 1e-12),
                                            DoubleNear(0.02, 1e-12)));
  const std::vector<double> large = {0.9, 0.8};
  EXPECT_THAT(holmCorrected(large), ElementsAre(1, 1));
  EXPECT_TRUE(holmCorrected({}).empty());
}

TEST(PairedStatistics, ASideIsTakenByRanks) {
  EXPECT_EQ(signedRankSide(std::vector<double>{1, 2, 3}), 1);
  EXPECT_EQ(signedRankSide(std::vector<double>{-1, 2, -3}), -1);
  EXPECT_EQ(signedRankSide(std::vector<double>{1, 1, 1, -9}), 1);  // ranks 2, 2, 2 against 4
  EXPECT_EQ(signedRankSide(std::vector<double>{1, 1, -9}), 0);
  EXPECT_EQ(signedRankSide({}), 0);
}

}  // namespace
}  // namespace limber
