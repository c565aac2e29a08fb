#include "limber/geometry/mesh/edge_groups.h"

#include <algorithm>
#include <numeric>

namespace limber {

namespace {

// Few vertices have more sides than this; for those a sort by insertion is the quickest.
constexpr std::size_t kFew = 24;

struct SideEntry {
  Index high, side;
  bool operator<(const SideEntry& other) const { return high != other.high ? high < other.high : side < other.side; }
};

void sortFew(SideEntry* begin, SideEntry* end) {
  if (begin == end) return;
  for (SideEntry* it = begin + 1; it < end; ++it) {
    const SideEntry entry = *it;
    SideEntry* at = it;
    for (; at > begin && entry < at[-1]; --at) *at = at[-1];
    *at = entry;
  }
}

}  // namespace

EdgeGroups::EdgeGroups(std::span<const Triangle> triangles, Index vertexCount) : triangles_(triangles) {
  const Index sideCount = static_cast<Index>(3 * triangles.size());
  std::vector<std::size_t> first(vertexCount + std::size_t{1}, 0);
  for (Index side = 0; side < sideCount; ++side) ++first[low(side) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  // One bucket for each lower vertex, its sides in order; then each bucket by the higher vertex.
  std::vector<SideEntry> entries(sideCount);
  std::vector<std::size_t> end(first.begin(), first.end() - 1);
  for (Index side = 0; side < sideCount; ++side) entries[end[low(side)]++] = {high(side), side};
  for (Index v = 0; v < vertexCount; ++v) {
    SideEntry *from = entries.data() + first[v], *to = entries.data() + first[v + 1];
    if (first[v + 1] - first[v] > kFew) {
      std::sort(from, to);
    } else {
      sortFew(from, to);
    }
  }
  sides_.reserve(sideCount);
  for (const SideEntry& entry : entries) sides_.push_back(entry.side);
}

}  // namespace limber
