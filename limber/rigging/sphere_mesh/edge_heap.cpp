#include "limber/rigging/sphere_mesh/edge_heap.h"

#include <algorithm>

namespace limber {

void EdgeHeap::siftUp(Index slot, std::uint64_t entry) {
  while (slot > 0 && entry < at(parent(slot))) {
    put(slot, at(parent(slot)));
    slot = parent(slot);
  }
  put(slot, entry);
}

void EdgeHeap::siftDown(Index slot, std::uint64_t entry) {
  for (;;) {
    const std::uint64_t first = std::uint64_t{slot} * kArity + 1;
    if (first >= count_) break;
    const std::uint64_t* const children = lines_[slot + 1].entries;
    const Index count = static_cast<Index>(std::min<std::uint64_t>(kArity, count_ - first));
    std::uint64_t least = children[0];
    Index which = 0;
    for (Index i = 1; i < count; ++i) {
      const bool less = children[i] < least;
      least = less ? children[i] : least;
      which = less ? i : which;
    }
    if (entry <= least) break;
    put(slot, least);
    slot = static_cast<Index>(first) + which;
  }
  put(slot, entry);
}

}  // namespace limber
