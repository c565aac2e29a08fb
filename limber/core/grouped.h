// Items in groups, such as the triangles at each vertex of a mesh, one group after another in one array.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

template <class Item>
class Grouped {
 public:
  Grouped() = default;
  // forEach  is called twice with a function visit(group, item), which it calls for every item, in the same order both
  //          times; each group keeps that order
  // Cost: O(groupCount + #items).
  template <class ForEach>
  Grouped(std::size_t groupCount, const ForEach& forEach) : begin_(groupCount + 2, 0) {
    forEach([&](std::size_t group, const Item&) { ++begin_[group + 2]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    items_.resize(begin_.back());
    forEach([&](std::size_t group, const Item& item) { items_[begin_[group + 1]++] = item; });
    begin_.pop_back();
  }

  std::size_t count() const { return begin_.size() - 1; }
  const std::vector<Item>& items() const { return items_; }
  std::span<const Item> of(std::size_t group) const {
    return {items_.data() + begin_[group], begin_[group + 1] - begin_[group]};
  }
  std::span<Item> of(std::size_t group) { return {items_.data() + begin_[group], begin_[group + 1] - begin_[group]}; }

 private:
  std::vector<std::size_t> begin_ = {0};  // #groups + 1, into the items
  std::vector<Item> items_;
};

// The numbers 0, 1, ... by the group that each belongs to, ascending.
inline Grouped<Index> numbersByGroup(std::span<const Index> groupOf, std::size_t groupCount) {
  return {groupCount, [&](const auto& visit) {
            for (Index i = 0; i < groupOf.size(); ++i) visit(groupOf[i], i);
          }};
}

}  // namespace limber
