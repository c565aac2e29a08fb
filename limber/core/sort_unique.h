// Lists in rising order without repeats.
#pragma once

#include <algorithm>
#include <vector>

namespace limber {

// Sorts the values and keeps one of those that are equal.
template <typename Value>
void sortUnique(std::vector<Value>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace limber
