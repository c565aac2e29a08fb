#include "limber/character/matching/limb_groups.h"

#include <algorithm>
#include <cmath>

namespace limber {

std::vector<std::vector<Index>> groupedAlong(std::span<const Index> limb, std::span<const double> own,
                                             std::span<const double> others) {
  const std::size_t count = std::min(own.size(), others.size());
  std::vector<std::vector<Index>> groups;
  std::size_t next = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto off = [&](std::size_t j) { return std::abs(own[j] - others[i]); };
    std::size_t begin = next;
    for (std::size_t j = next + 1; i > 0 && j + (count - i) <= limb.size(); ++j) {
      if (off(j) < off(begin)) begin = j;
    }
    for (; next < begin; ++next) groups.back().push_back(limb[next]);
    groups.push_back({limb[next++]});
  }
  for (; next < limb.size(); ++next) groups.back().push_back(limb[next]);
  return groups;
}

}  // namespace limber
