#include "limber/skinning/weight_edit.h"

#include <algorithm>
#include <map>

namespace limber {

namespace {

constexpr int kSmoothPasses = 12;  // at full strength a step from 0 to 1 is spread over some eight edges
// Of the way to the mean, at most: a whole step lets neighbours swap their weights back and forth.
constexpr double kSmoothStep = 0.6;

double sumOf(std::span<const Influence> influences) {
  double sum = 0;
  for (const Influence& influence : influences) sum += influence.weight;
  return sum;
}

bool stronger(const Influence& a, const Influence& b) {
  return a.weight > b.weight || (a.weight == b.weight && a.joint < b.joint);
}

bool names(std::span<const Influence> influences, Index joint) {
  return std::any_of(influences.begin(), influences.end(), [&](const Influence& i) { return i.joint == joint; });
}

}  // namespace

WeightRow::WeightRow(SkinWeights& weights, Index vertex, const std::vector<bool>& locked)
    : joints_(weights.joints.data() + std::size_t{vertex} * weights.slots, weights.slots),
      weights_(weights.weights.data() + std::size_t{vertex} * weights.slots, weights.slots),
      locked_(locked) {}

double WeightRow::of(Index joint) const {
  double sum = 0;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (joints_[k] == joint) sum += weights_[k];
  }
  return sum;
}

double WeightRow::unlocked() const {
  double sum = 0;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (weights_[k] > 0 && locked_[joints_[k]]) sum += weights_[k];
  }
  return std::max(0.0, 1 - sum);
}

void WeightRow::set(std::span<const Influence> wanted, std::optional<Index> heir) {
  const double room = unlocked();
  std::vector<Influence> shares;
  for (const Influence& influence : wanted) {
    if (!locked_[influence.joint]) shares.push_back({influence.joint, std::clamp(influence.weight, 0.0, room)});
  }
  const double asked = sumOf(shares);
  if (shares.empty() || !(room > 0)) return;
  for (Influence& share : shares) share.weight *= asked > room ? room / asked : 1;

  std::vector<Influence> others;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (weights_[k] > 0 && !locked_[joints_[k]] && !names(wanted, joints_[k])) {
      others.push_back({joints_[k], weights_[k]});
    }
  }
  const double rest = std::max(0.0, room - asked), theirs = sumOf(others);
  if (others.empty() && rest > 0 && heir && !locked_[*heir] && !names(wanted, *heir)) {
    others.push_back({*heir, rest});
  } else {
    for (Influence& other : others) other.weight *= rest / theirs;
  }
  shares.insert(shares.end(), others.begin(), others.end());
  replace(std::move(shares));
}

void WeightRow::replace(std::vector<Influence> shares) {
  const double room = unlocked();
  std::erase_if(shares, [&](const Influence& share) { return !(share.weight > 0) || locked_[share.joint]; });
  std::vector<Influence> row;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (weights_[k] > 0 && locked_[joints_[k]]) row.push_back({joints_[k], weights_[k]});
  }
  std::sort(shares.begin(), shares.end(), stronger);
  shares.resize(std::min(shares.size(), joints_.size() - row.size()));
  const double sum = sumOf(shares);
  if (!(sum > 0) || !(room > 0)) return;
  for (const Influence& share : shares) row.push_back({share.joint, share.weight * room / sum});
  std::sort(row.begin(), row.end(), stronger);
  std::fill(joints_.begin(), joints_.end(), Index{0});
  std::fill(weights_.begin(), weights_.end(), 0.0f);
  for (std::size_t k = 0; k < row.size(); ++k) {
    const auto weight = static_cast<float>(row[k].weight);
    if (!(weight > 0)) break;
    joints_[k] = row[k].joint;
    weights_[k] = weight;
  }
}

void smoothWeights(SkinWeights& weights, std::span<const SmoothAmount> amounts, const std::vector<bool>& locked) {
  using Row = std::map<Index, double>;
  std::map<Index, Row> rows;  // of all that is moved or looked at
  const auto read = [&](Index v) {
    const auto [row, isNew] = rows.try_emplace(v);
    for (Index k = 0; isNew && k < weights.slots; ++k) {
      if (weights.weightsOf(v)[k] > 0) row->second[weights.jointsOf(v)[k]] += weights.weightsOf(v)[k];
    }
  };
  for (const SmoothAmount& at : amounts) {
    read(at.vertex);
    for (const Index v : at.neighbours) read(v);
  }
  std::vector<Row> next(amounts.size());
  for (int pass = 0; pass < kSmoothPasses; ++pass) {
    for (std::size_t i = 0; i < amounts.size(); ++i) {
      const SmoothAmount& at = amounts[i];
      next[i] = rows[at.vertex];
      if (at.neighbours.empty()) continue;
      const double step = kSmoothStep * at.amount;
      for (auto& [joint, weight] : next[i]) weight *= 1 - step;
      const double each = step / static_cast<double>(at.neighbours.size());
      for (const Index v : at.neighbours) {
        for (const auto& [joint, weight] : rows[v]) next[i][joint] += each * weight;
      }
    }
    for (std::size_t i = 0; i < amounts.size(); ++i) rows[amounts[i].vertex] = next[i];
  }
  for (const SmoothAmount& at : amounts) {
    std::vector<Influence> shares;
    for (const auto& [joint, weight] : rows[at.vertex]) shares.push_back({joint, weight});
    WeightRow(weights, at.vertex, locked).replace(std::move(shares));
  }
}

}  // namespace limber
