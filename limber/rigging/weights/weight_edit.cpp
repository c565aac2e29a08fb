#include "limber/rigging/weights/weight_edit.h"

#include <algorithm>
#include <unordered_map>

namespace limber {

namespace {

constexpr int kSmoothPasses = 12;  // at full strength a step from 0 to 1 is spread over some eight edges
// Of the step to the mean, at most: a whole step lets neighbours swap their weights back and forth.
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

// The weights of the vertices that are moved or looked at, over the joints that any of them has: a brush holds a small
// part of the rig.
class DenseRows {
 public:
  DenseRows(const SkinWeights& weights, std::span<const SmoothAmount> amounts) : amounts_(amounts) {
    // Those that move come first, in their order.
    std::vector<Index> vertices;
    std::unordered_map<Index, Index> rowOf;  // looked up alone, never walked
    const auto row = [&](Index vertex) {
      const auto [known, isNew] = rowOf.try_emplace(vertex, static_cast<Index>(vertices.size()));
      if (isNew) vertices.push_back(vertex);
      return known->second;
    };
    for (const SmoothAmount& at : amounts) row(at.vertex);
    for (const SmoothAmount& at : amounts) {
      for (const Index next : at.neighbours) neighbours_.push_back(row(next));
    }
    for (const Index v : vertices) {
      for (Index k = 0; k < weights.slots; ++k) {
        if (weights.weightsOf(v)[k] > 0) joints_.push_back(weights.jointsOf(v)[k]);
      }
    }
    std::sort(joints_.begin(), joints_.end());
    joints_.erase(std::unique(joints_.begin(), joints_.end()), joints_.end());
    values_.assign(vertices.size() * joints_.size(), 0);
    for (std::size_t r = 0; r < vertices.size(); ++r) {
      for (Index k = 0; k < weights.slots; ++k) {
        const float weight = weights.weightsOf(vertices[r])[k];
        if (weight > 0) values_[r * joints_.size() + columnOf(weights.jointsOf(vertices[r])[k])] += weight;
      }
    }
    next_.resize(amounts.size() * joints_.size());
  }

  void smooth() {
    const std::size_t columns = joints_.size();
    const Index* neighbour = neighbours_.data();
    for (std::size_t i = 0; i < amounts_.size(); ++i) {
      const std::size_t count = amounts_[i].neighbours.size();
      const double step = count > 0 ? kSmoothStep * amounts_[i].amount : 0;
      double* out = next_.data() + i * columns;
      for (std::size_t c = 0; c < columns; ++c) out[c] = (1 - step) * values_[i * columns + c];
      for (std::size_t n = 0; n < count; ++n, ++neighbour) {
        const double* other = values_.data() + *neighbour * columns;
        for (std::size_t c = 0; c < columns; ++c) out[c] += step / static_cast<double>(count) * other[c];
      }
    }
    std::copy(next_.begin(), next_.end(), values_.begin());
  }

  std::vector<Influence> jointWeightsOf(std::size_t row) const {
    std::vector<Influence> influences;
    for (std::size_t c = 0; c < joints_.size(); ++c)
      influences.push_back({joints_[c], values_[row * joints_.size() + c]});
    return influences;
  }

 private:
  std::size_t columnOf(Index joint) const {
    return static_cast<std::size_t>(std::lower_bound(joints_.begin(), joints_.end(), joint) - joints_.begin());
  }

  std::span<const SmoothAmount> amounts_;
  std::vector<Index> neighbours_;      // rows, one vertex's behind the other's
  std::vector<Index> joints_;          // ascending
  std::vector<double> values_, next_;  // rows * joints; of those that move alone
};

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
  std::vector<Influence> influences;
  for (const Influence& influence : wanted) {
    if (!locked_[influence.joint]) influences.push_back({influence.joint, std::clamp(influence.weight, 0.0, room)});
  }
  const double asked = sumOf(influences);
  if (influences.empty() || !(room > 0)) return;
  for (Influence& part : influences) part.weight *= asked > room ? room / asked : 1;

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
  influences.insert(influences.end(), others.begin(), others.end());
  replace(std::move(influences));
}

void WeightRow::replace(std::vector<Influence> influences) {
  const double room = unlocked();
  std::erase_if(influences,
                [&](const Influence& influence) { return !(influence.weight > 0) || locked_[influence.joint]; });
  std::vector<Influence> row;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    if (weights_[k] > 0 && locked_[joints_[k]]) row.push_back({joints_[k], weights_[k]});
  }
  std::sort(influences.begin(), influences.end(), stronger);
  influences.resize(std::min(influences.size(), joints_.size() - row.size()));
  const double sum = sumOf(influences);
  if (!(sum > 0) || !(room > 0)) return;
  for (const Influence& influence : influences) row.push_back({influence.joint, influence.weight * room / sum});
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
  DenseRows rows(weights, amounts);
  for (int pass = 0; pass < kSmoothPasses; ++pass) rows.smooth();
  for (std::size_t i = 0; i < amounts.size(); ++i) {
    WeightRow(weights, amounts[i].vertex, locked).replace(rows.jointWeightsOf(i));
  }
}

}  // namespace limber
