#include "limber/character/anatomy/part_field.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

constexpr double kImpossible = -1e9;  // log-likelihood, far below any sum of weights

double logSumExp(const PartField::Scores& scores) {
  const double most = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (const double score : scores) {
    if (score > most - 40) sum += std::exp(score - most);
  }
  return most + std::log(sum);
}

}  // namespace

void PartWeights::prepare() {
  padded.assign(feature.size() / kPartStates * kPaddedStates, 0);
  for (std::size_t i = 0; i < feature.size(); ++i)
    padded[i / kPartStates * kPaddedStates + i % kPartStates] = feature[i];
  for (std::size_t p = 0; p < kPartStates; ++p) {
    followers[p].clear();
    for (std::size_t c = 0; c < kPartStates; ++c) {
      const float weight = follow[p * kPartStates + c];
      const bool may = weight > kNever / 2;
      if (may) followers[p].push_back(static_cast<std::uint8_t>(c));
      followFactor[p * kPartStates + c] = may ? std::exp(static_cast<double>(weight)) : 0;
    }
  }
}

void addScores(const BodyMeasures::Table& table, const PartWeights& weights, StateScores& scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    float sum[kPaddedStates] = {};
    for (std::size_t f = table.rows[i]; f < table.rows[i + 1]; ++f) {
      const float* row = weights.padded.data() + table.list[f].number * kPaddedStates;
      const float value = table.list[f].value;
#pragma GCC unroll 24
      for (std::size_t s = 0; s < kPaddedStates; ++s) sum[s] += value * row[s];
    }
    for (std::size_t s = 0; s < kPaddedStates; ++s) scores[i][s] += sum[s];
  }
}

PartField::PartField(const HalfBody& body, const StateScores& own, const PartWeights& weights,
                     std::span<const std::uint32_t> allowed)
    : body_(body), weights_(weights), own_(body.joints.size()) {
  for (std::size_t i = 0; i < own_.size(); ++i) {
    for (std::size_t s = 0; s < kPartStates; ++s) {
      own_[i][s] = allowed[i] >> s & 1 ? static_cast<double>(own[i][s]) : kImpossible;
    }
  }
  sumUp();
}

void PartField::sumUp() {
  below_ = own_;
  toParent_.resize(own_.size());
  logSum_ = 0;
  for (std::size_t i = own_.size(); i-- > 0;) {
    const std::optional<Index>& parent = body_.joints[i].parent;
    if (!parent) {
      logSum_ += logSumExp(below_[i]);
      continue;
    }
    const double most = *std::max_element(below_[i].begin(), below_[i].end());
    Scores fractions;
    for (std::size_t c = 0; c < kPartStates; ++c)
      fractions[c] = below_[i][c] > most - 60 ? std::exp(below_[i][c] - most) : 0;
    for (std::size_t p = 0; p < kPartStates; ++p) {
      double sum = 0;
      for (const std::uint8_t c : weights_.followers[p])
        sum += fractions[c] * weights_.followFactor[p * kPartStates + c];
      toParent_[i][p] = sum > 0 ? most + std::log(sum) : kImpossible;
      below_[*parent][p] += toParent_[i][p];
    }
  }
}

std::vector<PartState> PartField::best() const {
  std::vector<Scores> most = own_;
  std::vector<std::array<std::uint8_t, kPartStates>> choice(own_.size());
  for (std::size_t i = own_.size(); i-- > 0;) {
    const std::optional<Index>& parent = body_.joints[i].parent;
    if (!parent) continue;
    for (std::size_t p = 0; p < kPartStates; ++p) {
      double best = 2 * kImpossible;
      const float* row = weights_.follow.data() + p * kPartStates;
      for (const std::uint8_t c : weights_.followers[p]) {
        const double score = most[i][c] + static_cast<double>(row[c]);
        if (score <= best) continue;
        best = score;
        choice[i][p] = c;
      }
      most[*parent][p] += best;
    }
  }
  std::vector<PartState> states(own_.size());
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const std::optional<Index>& parent = body_.joints[i].parent;
    const auto own = std::max_element(most[i].begin(), most[i].end()) - most[i].begin();
    states[i] = static_cast<PartState>(parent ? choice[i][static_cast<std::size_t>(states[*parent])] : own);
  }
  return states;
}

double PartField::scoreOf(std::span<const PartState> states) const {
  double score = 0;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const auto s = static_cast<std::size_t>(states[i]);
    score += own_[i][s];
    if (const std::optional<Index>& parent = body_.joints[i].parent) {
      score += static_cast<double>(weights_.follow[static_cast<std::size_t>(states[*parent]) * kPartStates + s]);
    }
  }
  return score;
}

// Of all that does not hang on a half joint, by its state.
std::vector<PartField::Scores> PartField::outside() const {
  std::vector<Scores> from(own_.size(), Scores{});
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const std::optional<Index>& parent = body_.joints[i].parent;
    if (!parent) continue;
    Scores above;
    for (std::size_t p = 0; p < kPartStates; ++p) above[p] = from[*parent][p] + below_[*parent][p] - toParent_[i][p];
    for (std::size_t c = 0; c < kPartStates; ++c) {
      Scores terms;
      for (std::size_t p = 0; p < kPartStates; ++p) {
        terms[p] = above[p] + static_cast<double>(weights_.follow[p * kPartStates + c]);
      }
      from[i][c] = logSumExp(terms);
    }
  }
  return from;
}

std::vector<PartField::Scores> PartField::marginals() const {
  std::vector<Scores> all = outside();
  for (std::size_t i = 0; i < own_.size(); ++i) {
    for (std::size_t s = 0; s < kPartStates; ++s) all[i][s] += below_[i][s];
    const double whole = logSumExp(all[i]);
    for (double& score : all[i]) score = score > whole - 60 ? std::exp(score - whole) : 0;
  }
  return all;
}

std::vector<double> PartField::followMarginals() const {
  const std::vector<Scores> from = outside();
  std::vector<double> sums(kPartStates * kPartStates, 0);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const std::optional<Index>& parent = body_.joints[i].parent;
    if (!parent) continue;
    Scores above;
    Scores terms{};
    for (std::size_t p = 0; p < kPartStates; ++p) {
      above[p] = from[*parent][p] + below_[*parent][p] - toParent_[i][p];
      terms[p] = from[*parent][p] + below_[*parent][p];
    }
    const double whole = logSumExp(terms);
    for (std::size_t p = 0; p < kPartStates; ++p) {
      if (above[p] < whole - 1e6) continue;
      for (std::size_t c = 0; c < kPartStates; ++c) {
        const double score =
            above[p] + below_[i][c] + static_cast<double>(weights_.follow[p * kPartStates + c]) - whole;
        if (score > -60) sums[p * kPartStates + c] += std::exp(score);
      }
    }
  }
  return sums;
}

}  // namespace limber
