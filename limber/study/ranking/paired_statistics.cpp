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

// Twice the ranks of the differences that count, from 1, so that those of ties are whole numbers, and what they add up to on either side of 0.
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
  std::vector<double> magnitudes;
  for (const double d : sorted) magnitudes.push_back(std::abs(d));
  RankSums sums;
  for (const double rank : meanRanks(magnitudes)) sums.ranks.push_back(static_cast<std::size_t>(2 * (rank + 1)));
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
  Random random(1);
  std::vector<double> medians, drawn(values.size());
  for (int i = 0; i < kResamples; ++i) {
    for (double& value : drawn) value = values[random.below(values.size())];
    medians.push_back(median(drawn));
  }
  const auto [low, high] = percentileInterval(std::move(medians));
  return {median({values.begin(), values.end()}), low, high};
}

std::vector<double> meanRanks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t i = begin; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(begin + end - 1);
  }
  return ranks;
}

Interval percentileInterval(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const auto at = [&](double part) {
    return samples[static_cast<std::size_t>(part * static_cast<double>(samples.size() - 1))];
  };
  return {at(kTail), at(1 - kTail)};
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
