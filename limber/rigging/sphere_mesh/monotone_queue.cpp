#include "limber/rigging/sphere_mesh/monotone_queue.h"

#include <algorithm>

namespace limber {

void MonotoneQueue::fill(const std::vector<float>& keys) {
  for (std::vector<std::uint64_t>& bucket : buckets_) bucket.clear();
  occupied_ = 0;
  bound_ = 0;
  announced_ = 0;
  slots_.resize(keys.size());
  for (Index e = 0; e < keys.size(); ++e) {
    slots_[e].key = keys[e];
    put(pack(e, keys[e]));
  }
}

// Raises the bound to the least entry of the lowest bucket; the rest of it goes to lower ones.
void MonotoneQueue::dealOut(int bucket) {
  std::vector<std::uint64_t>& entries = buckets_[bucket];
  bound_ = *std::min_element(entries.begin(), entries.end());
  dealt_.swap(entries);
  occupied_ &= ~(std::uint64_t{1} << (bucket - 1));
  for (const std::uint64_t entry : dealt_) put(entry);
  dealt_.clear();
  announced_ = 0;
}

void MonotoneQueue::raise(Index edge, float key) {
  Slot& slot = slots_[edge];
  if (!(key > slot.key)) return;
  takeOut(bucketOf(pack(edge, slot.key)), slot.position);
  slot.key = key;
  put(pack(edge, key));
}

}  // namespace limber
