// The weights of a vertex changed by hand: what one joint gets others give, and locked joints neither give nor take.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/skeleton/skin_weights.h"

namespace limber {

struct Influence {
  Index joint = 0;
  double weight = 0;
};

// One vertex's slots, to be changed. Where nothing can change (all that it has is locked, or nobody is there to give or
// take) the functions below leave every bit as it is; else locked joints keep theirs, the others share what these leave
// of 1, the strongest that there are slots for.
class WeightRow {
 public:
  // locked  #J
  WeightRow(SkinWeights& weights, Index vertex, const std::vector<bool>& locked);

  double of(Index joint) const;

  // These joints get these weights, from 0 to what is not locked; the others give or take in proportion. Where no other
  // joint is unlocked the rest goes to `heir`; without one the weights stay. Locked joints among them are passed over.
  void set(std::span<const Influence> wanted, std::optional<Index> heir = std::nullopt);

  // In proportion to these; joints at most once.
  void replace(std::vector<Influence> influences);

 private:
  double unlocked() const;

  std::span<Index> joints_;
  std::span<float> weights_;
  const std::vector<bool>& locked_;
};

// Laplacian smoothing: each vertex moves towards the mean of its neighbours' weights, all at once, again and again.
// Vertices that are not among `amounts` stay and are only looked at.
struct SmoothAmount {
  Index vertex = 0;
  double amount = 0;              // 0 to 1: how much
  std::vector<Index> neighbours;  // any order; the mean is even over them
};
void smoothWeights(SkinWeights& weights, std::span<const SmoothAmount> amounts, const std::vector<bool>& locked);

}  // namespace limber
