#include "limber/document/mesh/vertex_join.h"

#include <bit>
#include <cstring>

#include "limber/core/file/bits.h"

namespace limber {

void VertexRows::add(float value) {
  words_.push_back(bitCast<std::uint32_t>(value + 0.0f));
}

bool VertexRows::equal(std::size_t a, std::size_t b) const {
  return std::memcmp(&words_[a * width_], &words_[b * width_], width_ * sizeof(std::uint32_t)) == 0;
}

std::uint64_t VertexRows::hash(std::size_t row) const {
  std::uint64_t h = 0;
  for (std::size_t i = row * width_; i < (row + 1) * width_; ++i) {
    h = (h ^ words_[i]) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return h;
}

JoinedVertices joinVertices(const VertexRows& rows) {
  const std::size_t count = rows.count();
  JoinedVertices result;
  result.vertex.resize(count);
  std::vector<Index> slots(std::bit_ceil(2 * count + 2), kNoIndex);  // open addressing, indices into `kept`
  const std::size_t mask = slots.size() - 1;
  for (std::size_t v = 0; v < count; ++v) {
    std::size_t slot = rows.hash(v) & mask;
    while (slots[slot] != kNoIndex && !rows.equal(result.kept[slots[slot]], v)) slot = (slot + 1) & mask;
    if (slots[slot] == kNoIndex) {
      slots[slot] = static_cast<Index>(result.kept.size());
      result.kept.push_back(static_cast<Index>(v));
    }
    result.vertex[v] = slots[slot];
  }
  return result;
}

}  // namespace limber
