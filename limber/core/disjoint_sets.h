// Sets that grow together (union-find).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// `count` elements, each a set of its own at first. A set is named by its lowest element. Both calls take next to
// constant time.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count), count_(count) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  // The name of the element's set, found with path halving.
  Index find(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  // False where both were in one set already.
  bool unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
    return true;
  }

  // Sets that are left.
  std::size_t count() const { return count_; }

 private:
  std::vector<Index> parent_;  // never above its child
  std::size_t count_;
};

}  // namespace limber
