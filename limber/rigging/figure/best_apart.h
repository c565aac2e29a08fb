// The best of many that are alike in part.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace limber {

// At most `most`, those first for which `value` is largest; none that is like one before it.
//
// alike  whether one is as good as another: alike(kept, candidate)
template <class T, class Value, class Alike>
std::vector<T> bestApart(std::vector<T> ones, std::size_t most, const Value& value, const Alike& alike) {
  std::stable_sort(ones.begin(), ones.end(), [&](const T& a, const T& b) { return value(a) > value(b); });
  std::vector<T> apart;
  for (const T& one : ones) {
    if (apart.size() >= most) break;
    if (std::none_of(apart.begin(), apart.end(), [&](const T& kept) { return alike(kept, one); })) apart.push_back(one);
  }
  return apart;
}

// The same of ones that are never alike.
template <class T, class Value>
std::vector<T> bestOf(std::vector<T> ones, std::size_t most, const Value& value) {
  return bestApart(std::move(ones), most, value, [](const T&, const T&) { return false; });
}

}  // namespace limber
