#include "limber/geometry/mesh/edge_groups.h"

#include <algorithm>

#include "limber/core/grouped.h"

namespace limber {

namespace {

// Few vertices have more sides than this; for those a sort by insertion is the quickest.
constexpr std::size_t kFew = 24;

struct SideEntry {
  Index high, side;
  bool operator<(const SideEntry& other) const { return high != other.high ? high < other.high : side < other.side; }
};

void sortFew(std::span<SideEntry> entries) {
  for (std::size_t i = 1; i < entries.size(); ++i) {
    const SideEntry entry = entries[i];
    std::size_t at = i;
    for (; at > 0 && entry < entries[at - 1]; --at) entries[at] = entries[at - 1];
    entries[at] = entry;
  }
}

}  // namespace

EdgeGroups::EdgeGroups(std::span<const Triangle> triangles, Index vertexCount) : triangles_(triangles) {
  const Index sideCount = static_cast<Index>(3 * triangles.size());
  Grouped<SideEntry> byLow(vertexCount, [&](const auto& visit) {
    for (Index side = 0; side < sideCount; ++side) visit(low(side), {high(side), side});
  });
  sides_.reserve(sideCount);
  for (Index v = 0; v < vertexCount; ++v) {
    const std::span<SideEntry> entries = byLow.of(v);
    if (entries.size() > kFew) {
      std::sort(entries.begin(), entries.end());
    } else {
      sortFew(entries);
    }
    for (const SideEntry& entry : entries) sides_.push_back(entry.side);
  }
}

}  // namespace limber
