#include "limber/study/ranking/paired_statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "limber/core/random.h"
#include "limber/evaluate/median.h"

namespace limber {

namespace {

constexpr int kResamples = 2000;
constexpr double kTail = 0.025;  // on either side of the interval
constexpr std::size_t kMaxExact = 200;

// Twice the mean ranks of the magnitudes, so that those of ties are whole numbers.
std::vector<std::size_t> doubledRanks(std::span<const double> sorted) {
  std::vector<std::size_t> ranks(sorted.size());
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && std::abs(sorted[end]) == std::abs(sorted[begin])) ++end;
    std::fill(ranks.begin() + static_cast<std::ptrdiff_t>(begin), ranks.begin() + static_cast<std::ptrdiff_t>(end),
              begin + 1 + end);
  }
  return ranks;
}

// Doubled ranks of the differences that count, and what they add up to on either side of 0.
struct RankSums {
  std::vector<std::size_t> ranks;
  std::size_t positive = 0, negative = 0;
};

RankSums rankSums(std::span<const double> differences) {
  std::vector<double> sorted;
  for (const double d : differences) {
    if (d != 0 && !std::isnan(d)) sorted.push_back(d);
  }
  std::sort(sorted.begin(), sorted.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  RankSums sums;
  sums.ranks = doubledRanks(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i) (sorted[i] > 0 ? sums.positive : sums.negative) += sums.ranks[i];
  return sums;
}

// Of all choices of signs, the part whose positive ranks add up to at most `least`.
double lowerTail(std::span<const std::size_t> ranks, std::size_t least) {
  std::vector<double> probability(std::accumulate(ranks.begin(), ranks.end(), std::size_t{0}) + 1);
  probability[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t rank : ranks) {
    reached += rank;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      probability[sum] = 0.5 * (probability[sum] + (sum >= rank ? probability[sum - rank] : 0));
    }
  }
  return std::accumulate(probability.begin(), probability.begin() + static_cast<std::ptrdiff_t>(least) + 1, 0.0);
}

double normalTail(std::span<const std::size_t> ranks, std::size_t least) {
  double mean = 0, variance = 0;
  for (const std::size_t rank : ranks) {
    const double r = static_cast<double>(rank);
    mean += 0.5 * r;
    variance += 0.25 * r * r;
  }
  constexpr double kContinuity = 1;  // half a rank, doubled
  const double z = std::max(0.0, mean - static_cast<double>(least) - kContinuity) / std::sqrt(variance);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace

MedianInterval bootstrapMedian(std::span<const double> values) {
  MedianInterval interval;
  interval.median = median({values.begin(), values.end()});
  Random random(1);
  std::vector<double> medians, drawn(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : drawn) value = values[random.below(values.size())];
    medians.push_back(median(drawn));
  }
  std::sort(medians.begin(), medians.end());
  const auto at = [&](double part) { return medians[static_cast<std::size_t>(part * (kResamples - 1))]; };
  interval.low = at(kTail);
  interval.high = at(1 - kTail);
  return interval;
}

double signedRankP(std::span<const double> differences) {
  const RankSums sums = rankSums(differences);
  if (sums.ranks.empty()) return 1;
  const std::size_t least = std::min(sums.positive, sums.negative);
  const double tail = sums.ranks.size() <= kMaxExact ? lowerTail(sums.ranks, least) : normalTail(sums.ranks, least);
  return std::min(1.0, 2 * tail);
}

int signedRankSide(std::span<const double> differences) {
  const RankSums sums = rankSums(differences);
  return sums.positive > sums.negative ? 1 : sums.positive < sums.negative ? -1 : 0;
}

std::vector<double> holmCorrected(std::span<const double> pValues) {
  std::vector<std::size_t> order(pValues.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pValues[a] < pValues[b]; });
  std::vector<double> corrected(pValues.size());
  double most = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    most = std::max(most, std::min(1.0, static_cast<double>(order.size() - i) * pValues[order[i]]));
    corrected[order[i]] = most;
  }
  return corrected;
}

}  // namespace limber
