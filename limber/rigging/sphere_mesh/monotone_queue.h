// Priority queue over edges whose keys only grow, for a sequence of tops that only grows.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "limber/core/file/bits.h"
#include "limber/core/types.h"

namespace limber {

// A radix heap (Ahuja, Mehlhorn, Orlin, Tarjan: Faster Algorithms for the Shortest Path Problem, 1990) with a slot for
// each edge, so that edges are raised and removed in place. An entry packs a key's bits (keys are floats >= 0, whose
// bits order as they do) above the edge's index: ties go by index. Entries are bucketed by the highest bit in which
// they differ from a bound that no entry is below; when the lowest bucket is needed it is dealt out to lower ones.
// Raising and removing are O(1); an entry is dealt out at most once for each of 64 buckets, a few times in practice,
// and in order of memory, where a binary heap of this size would miss the cache at every level.
class MonotoneQueue {
 public:
  // All edges with their keys.
  void fill(const std::vector<float>& keys);

  bool empty() const { return occupied_ == 0 && buckets_[0].empty(); }
  // The edge with the least key; not of an empty queue. Calls soon(edge) for edges that are likely to come to the top
  // within a few steps, so that what belongs to them can be fetched from memory.
  template <typename Soon>
  Index top(const Soon& soon);
  Index top() {
    return top([](Index) {});
  }
  // The edge that comes after top() if nothing changes; kNoIndex if that is not known.
  Index next() const { return next_; }
  bool contains(Index edge) const { return slots_[edge].position != kNoIndex; }
  float key(Index edge) const { return slots_[edge].key; }

  // `key` is not less than the edge's key; a smaller one leaves it as it is.
  void raise(Index edge, float key);
  void remove(Index edge) {
    const Slot slot = slots_[edge];
    takeOut(bucketOf(pack(edge, slot.key)), slot.position);
    slots_[edge].position = kNoIndex;
  }

 private:
  struct Slot {
    float key = 0;
    Index position = kNoIndex;  // in its bucket
  };
  static constexpr std::size_t kFew = 12;  // so many are searched rather than dealt out

  static std::uint64_t pack(Index edge, float key) { return std::uint64_t{bitCast<std::uint32_t>(key)} << 32 | edge; }
  int lowest() const { return std::countr_zero(occupied_) + 1; }
  void dealOut(int bucket);
  int bucketOf(std::uint64_t entry) const { return static_cast<int>(std::bit_width(entry ^ bound_)); }

  void put(std::uint64_t entry) {
    const int bucket = bucketOf(entry);
    slots_[static_cast<Index>(entry)].position = static_cast<Index>(buckets_[bucket].size());
    buckets_[bucket].push_back(entry);
    if (bucket > 0) occupied_ |= std::uint64_t{1} << (bucket - 1);
  }
  void takeOut(int bucket, Index position) {
    std::vector<std::uint64_t>& entries = buckets_[bucket];
    entries[position] = entries.back();
    slots_[static_cast<Index>(entries[position])].position = position;
    entries.pop_back();
    if (bucket > 0 && entries.empty()) occupied_ &= ~(std::uint64_t{1} << (bucket - 1));
  }

  std::array<std::vector<std::uint64_t>, 65> buckets_;
  std::uint64_t occupied_ = 0;  // bit b - 1: bucket b has entries
  std::uint64_t bound_ = 0;     // no entry is less
  std::vector<Slot> slots_;     // per edge
  std::vector<std::uint64_t> dealt_;
  Index next_ = kNoIndex;
  int announced_ = 0;  // the bucket for which soon() has been called
};

template <typename Soon>
Index MonotoneQueue::top(const Soon& soon) {
  next_ = kNoIndex;
  if (buckets_[0].empty() && buckets_[lowest()].size() > kFew) dealOut(lowest());
  if (!buckets_[0].empty()) return static_cast<Index>(buckets_[0].front());  // equal to the bound: there is but one
  const int bucket = lowest();
  const std::vector<std::uint64_t>& entries = buckets_[bucket];
  if (bucket != announced_) {
    for (const std::uint64_t entry : entries) soon(static_cast<Index>(entry));
    announced_ = bucket;
  }
  std::uint64_t least = entries[0], second = ~std::uint64_t{0};
  for (std::size_t i = 1; i < entries.size(); ++i) {
    second = std::min(second, std::max(least, entries[i]));
    least = std::min(least, entries[i]);
  }
  next_ = static_cast<Index>(second);  // all ones: kNoIndex
  return static_cast<Index>(least);
}

}  // namespace limber
