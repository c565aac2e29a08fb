// The best of many that are alike in part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace limber {

// The first `most` that are not like one before them, in order.
//
// alike  whether one is as good as another: alike(kept, candidate)
template <class T, class Alike>
std::vector<T> firstApart(const std::vector<T>& sorted, std::size_t most, const Alike& alike) {
  std::vector<T> apart;
  for (const T& one : sorted) {
    if (apart.size() >= most) break;
    if (std::none_of(apart.begin(), apart.end(), [&](const T& kept) { return alike(kept, one); })) apart.push_back(one);
  }
  return apart;
}

// The same, after they were sorted: first those for which `value` is largest.
template <class T, class Value, class Alike>
std::vector<T> bestApart(std::vector<T> ones, std::size_t most, const Value& value, const Alike& alike) {
  std::stable_sort(ones.begin(), ones.end(), [&](const T& a, const T& b) { return value(a) > value(b); });
  return firstApart(ones, most, alike);
}

}  // namespace limber
