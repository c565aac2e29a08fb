#include "limber/crowd/mixed_turns.h"

#include <numeric>
#include <utility>

namespace limber {

MixedTurns::MixedTurns(Index count, std::uint64_t seed) : random_(seed), order_(count), drawn_(count) {
  std::iota(order_.begin(), order_.end(), Index{0});
}

Index MixedTurns::next() {
  if (drawn_ == order_.size()) {
    for (std::size_t left = order_.size(); left > 1; --left) std::swap(order_[left - 1], order_[random_.below(left)]);
    drawn_ = 0;
  }
  return order_[drawn_++];
}

}  // namespace limber
