#include "limber/document/usd/lz4_block.h"

#include <cstring>

#include "limber/core/error.h"

namespace limber {

namespace {

// Of the format: the shortest match, how far back one may lie, the bytes at the end that are literals whatever they
// are, and those before which the last match has to begin.
constexpr std::size_t kShortestMatch = 4, kFarthest = 65535, kLastLiterals = 5, kLastMatchStart = 12;
constexpr std::size_t kMaxBytes = 0x7e000000;
constexpr unsigned kHashBits = 14;

std::uint32_t fourBytes(const std::uint8_t* at) {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof(value));
  return value;
}

std::size_t hashOf(std::uint32_t value) {
  return (value * 2654435761u) >> (32 - kHashBits);  // Knuth's multiplicative hash
}

// A length from 15 on goes on in bytes behind the token.
void appendLength(std::size_t length, Bytes& out) {
  for (length -= 15; length >= 255; length -= 255) out.push_back(255);
  out.push_back(static_cast<std::uint8_t>(length));
}

// Literals, and the match that follows them; matchLength 0: the last sequence of all.
void appendSequence(ByteSpan literals, std::size_t matchLength, std::size_t distance, Bytes& out) {
  const std::size_t extra = matchLength > 0 ? matchLength - kShortestMatch : 0;
  out.push_back(
      static_cast<std::uint8_t>(std::min<std::size_t>(literals.size(), 15) << 4 | std::min<std::size_t>(extra, 15)));
  if (literals.size() >= 15) appendLength(literals.size(), out);
  out.insert(out.end(), literals.begin(), literals.end());
  if (matchLength == 0) return;
  out.push_back(static_cast<std::uint8_t>(distance));
  out.push_back(static_cast<std::uint8_t>(distance >> 8));
  if (extra >= 15) appendLength(extra, out);
}

}  // namespace

Bytes encodeLz4Block(ByteSpan bytes) {
  if (bytes.size() > kMaxBytes) throw Error(ErrorCode::kLimit, "more than 2 GB in one list cannot be written");
  Bytes out;
  std::vector<std::uint32_t> lastOffset(std::size_t{1} << kHashBits, 0);  // behind the four bytes of a hash, 0: none
  std::size_t literalsFrom = 0, at = 0;
  while (at + kLastMatchStart < bytes.size()) {
    const std::uint32_t four = fourBytes(&bytes[at]);
    std::uint32_t& index = lastOffset[hashOf(four)];
    const std::size_t known = index;
    index = static_cast<std::uint32_t>(at + 1);
    if (known == 0 || at + 1 - known > kFarthest || fourBytes(&bytes[known - 1]) != four) {
      ++at;
      continue;
    }
    const std::size_t from = known - 1, most = bytes.size() - kLastLiterals - at;
    std::size_t length = kShortestMatch;
    while (length < most && bytes[from + length] == bytes[at + length]) ++length;
    appendSequence(bytes.subspan(literalsFrom, at - literalsFrom), length, at - from, out);
    at += length;
    literalsFrom = at;
  }
  appendSequence(bytes.subspan(literalsFrom), 0, 0, out);
  return out;
}

}  // namespace limber
