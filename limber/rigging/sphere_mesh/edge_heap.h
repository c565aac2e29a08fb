// Indexed priority queue over edges: the least key on top, keys changed and edges taken out in place.
#pragma once

#include <cstdint>
#include <vector>

#include "limber/core/file/bits.h"
#include "limber/core/types.h"

namespace limber {

// An eight-ary heap: the children of a slot lie in one cache line. An entry packs the key's bits (keys are floats >= 0,
// whose bits order as they do) above the edge's index, so that one integer comparison orders by key and breaks ties by
// index. Each operation is O(log #entries).
class EdgeHeap {
 public:
  // No edge of [0, edgeCount) is in the heap.
  void reset(Index edgeCount) {
    slots_.assign(edgeCount, kNoIndex);
    count_ = 0;
  }

  bool empty() const { return count_ == 0; }
  Index top() const { return edgeOf(at(0)); }
  bool contains(Index edge) const { return slots_[edge] != kNoIndex; }

  void insert(Index edge, float key) {
    grow(count_ + 1);
    siftUp(count_++, pack(edge, key));
  }
  void update(Index edge, float key) { settle(slots_[edge], pack(edge, key)); }
  void remove(Index edge) {
    const Index slot = slots_[edge];
    slots_[edge] = kNoIndex;
    const std::uint64_t last = at(--count_);
    if (slot < count_) settle(slot, last);
  }

 private:
  static constexpr Index kArity = 8;
  struct alignas(64) Line {
    std::uint64_t entries[kArity];
  };
  // Slot i > 0 is entry i + 7, slot 0 is entry 7, so that the children of i, 8 i + 1 to 8 i + 8, fill line i + 1.
  std::uint64_t& at(Index slot) { return lines_[(slot + kArity - 1) / kArity].entries[(slot + kArity - 1) % kArity]; }
  const std::uint64_t& at(Index slot) const {
    return lines_[(slot + kArity - 1) / kArity].entries[(slot + kArity - 1) % kArity];
  }
  static Index parent(Index slot) { return (slot - 1) / kArity; }
  void grow(Index count) {
    const std::size_t needed = std::size_t{count} / kArity + 2;
    if (lines_.size() < needed) lines_.resize(needed + needed / 2);
  }

  static std::uint64_t pack(Index edge, float key) { return std::uint64_t{bitCast<std::uint32_t>(key)} << 32 | edge; }
  static Index edgeOf(std::uint64_t entry) { return static_cast<Index>(entry); }

  void put(Index slot, std::uint64_t entry) {
    at(slot) = entry;
    slots_[edgeOf(entry)] = slot;
  }
  void settle(Index slot, std::uint64_t entry) {
    if (slot > 0 && entry < at(parent(slot))) {
      siftUp(slot, entry);
    } else {
      siftDown(slot, entry);
    }
  }
  void siftUp(Index slot, std::uint64_t entry);
  void siftDown(Index slot, std::uint64_t entry);

  std::vector<Line> lines_;
  Index count_ = 0;
  std::vector<Index> slots_;  // edge -> its slot, or kNoIndex
};

}  // namespace limber
