// Our own decoder instead of zlib, because a page has no zlib: its DecompressionStream is asynchronous, a reader is
// not, and a JavaScript decoder passed in would have to be fetched before anyone knows that the file is deflated. This
// is one code path everywhere, and one library less to install.
#include "limber/core/file/inflate.h"

#include <algorithm>
#include <array>

#include "limber/core/error.h"
#include "limber/core/file/deflate_ranges.h"

namespace limber {

namespace {

constexpr int kLongestCode = 15;  // bits
constexpr int kTableBits = 10;    // codes up to here are looked up, longer ones walked
constexpr int kMaxSymbols = 288;

[[noreturn]] void failDeflated(const char* what) {
  throw Error(ErrorCode::kBadData, what);
}

// Bits from the lowest of each byte upwards. Beyond the end come zeros; to consume one of them is an error.
class BitReader {
 public:
  explicit BitReader(ByteSpan bytes) : bytes_(bytes) {}

  void fill() {
    while (count_ <= 56 && at_ < bytes_.size()) {
      bits_ |= std::uint64_t{bytes_[at_++]} << count_;
      count_ += 8;
    }
  }
  // At most 32 bits, after fill().
  std::uint32_t peek(int count) const { return static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1)); }
  void skip(int count) {
    if (count > count_) failDeflated("deflated data are cut off");
    bits_ >>= count;
    count_ -= count;
  }
  std::uint32_t take(int count) {
    fill();
    const std::uint32_t value = peek(count);
    skip(count);
    return value;
  }

  // The bytes from the next whole one on.
  ByteSpan rest() {
    skip(count_ % 8);
    at_ -= static_cast<std::size_t>(count_ / 8);
    bits_ = 0;
    count_ = 0;
    return bytes_.subspan(at_);
  }
  void skipBytes(std::size_t count) { at_ += count; }

 private:
  ByteSpan bytes_;
  std::size_t at_ = 0;
  std::uint64_t bits_ = 0;
  int count_ = 0;
};

// A canonical Huffman code, given by the length of each symbol's code.
class HuffmanCode {
 public:
  explicit HuffmanCode(std::span<const std::uint8_t> lengths) {
    for (const std::uint8_t length : lengths) ++counts_[length];
    int free = 1;
    for (int length = 1; length <= kLongestCode; ++length) {
      free = 2 * free - counts_[length];
      if (free < 0) failDeflated("deflated data have a code with too many symbols");
    }
    // A single code of one bit is let pass, as zlib does: a block with one distance.
    const int used = static_cast<int>(lengths.size()) - counts_[0];
    if (free > 0 && !(used == 0 || (used == 1 && counts_[1] == 1))) {
      failDeflated("deflated data have a code with too few symbols");
    }
    std::array<int, kLongestCode + 2> start = {}, next = {};
    for (int length = 1; length <= kLongestCode; ++length) {
      start[length + 1] = start[length] + counts_[length];
      next[length + 1] = 2 * (next[length] + counts_[length]);
    }
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
      const int length = lengths[symbol];
      if (length == 0) continue;
      symbols_[start[length]++] = static_cast<std::uint16_t>(symbol);
      const int code = next[length]++;
      if (length <= kTableBits) addToTable(code, length, symbol);
    }
  }

  // After fill().
  int decode(BitReader& bits) const {
    const std::uint16_t entry = table_[bits.peek(kTableBits)];
    if (entry != 0) {
      bits.skip(entry & 15);
      return entry >> 4;
    }
    return decodeLong(bits);
  }

 private:
  void addToTable(int code, int length, std::size_t symbol) {
    int reversed = 0;
    for (int bit = 0; bit < length; ++bit) reversed |= (code >> bit & 1) << (length - 1 - bit);
    const auto entry = static_cast<std::uint16_t>(symbol << 4 | static_cast<std::size_t>(length));
    for (int index = reversed; index < 1 << kTableBits; index += 1 << length) table_[index] = entry;
  }

  int decodeLong(BitReader& bits) const {
    const std::uint32_t ahead = bits.peek(kLongestCode);
    int code = 0, first = 0, index = 0;  // of the codes of that length
    for (int length = 1; length <= kLongestCode; ++length) {
      code = 2 * code + static_cast<int>(ahead >> (length - 1) & 1);
      if (code - counts_[length] < first) {
        bits.skip(length);
        return symbols_[index + code - first];
      }
      index += counts_[length];
      first = 2 * (first + counts_[length]);
    }
    failDeflated("deflated data have a code without a symbol");
  }

  std::array<int, kLongestCode + 1> counts_ = {};
  std::array<std::uint16_t, kMaxSymbols> symbols_ = {};
  std::array<std::uint16_t, 1 << kTableBits> table_ = {};  // symbol and length; 0: a longer code, or none
};

struct BlockCodes {
  HuffmanCode literals, distances;
};

BlockCodes fixedCodes() {
  std::array<std::uint8_t, kMaxSymbols> lengths = {};
  std::fill(lengths.begin(), lengths.begin() + 144, std::uint8_t{8});
  std::fill(lengths.begin() + 144, lengths.begin() + 256, std::uint8_t{9});
  std::fill(lengths.begin() + 256, lengths.begin() + 280, std::uint8_t{7});
  std::fill(lengths.begin() + 280, lengths.end(), std::uint8_t{8});
  std::array<std::uint8_t, 32> distances = {};
  distances.fill(5);
  return {HuffmanCode(lengths), HuffmanCode(distances)};
}

BlockCodes readCodes(BitReader& bits) {
  const std::size_t literals = bits.take(5) + 257, distances = bits.take(5) + 1, ofLengths = bits.take(4) + 4;
  if (literals > 286 || distances > 30) failDeflated("deflated data have a code with too many symbols");
  constexpr std::array<std::uint8_t, 19> kOrder = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};
  std::array<std::uint8_t, 19> lengthLengths = {};
  for (std::size_t i = 0; i < ofLengths; ++i) lengthLengths[kOrder[i]] = static_cast<std::uint8_t>(bits.take(3));
  const HuffmanCode lengthCode(lengthLengths);

  std::array<std::uint8_t, 286 + 30> lengths = {};
  for (std::size_t at = 0; at < literals + distances;) {
    bits.fill();
    const int symbol = lengthCode.decode(bits);
    if (symbol < 16) {
      lengths[at++] = static_cast<std::uint8_t>(symbol);
      continue;
    }
    if (symbol == 16 && at == 0) failDeflated("deflated data repeat a length before the first");
    const std::uint8_t length = symbol == 16 ? lengths[at - 1] : std::uint8_t{0};
    const std::size_t repeat = symbol == 16 ? 3 + bits.take(2) : symbol == 17 ? 3 + bits.take(3) : 11 + bits.take(7);
    if (repeat > literals + distances - at) failDeflated("deflated data have more lengths than symbols");
    std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(at), repeat, length);
    at += repeat;
  }
  const std::span<const std::uint8_t> all(lengths);
  return {HuffmanCode(all.first(literals)), HuffmanCode(all.subspan(literals, distances))};
}

class Inflater {
 public:
  Inflater(ByteSpan bytes, std::span<std::uint8_t> out) : bits_(bytes), out_(out) {}

  // What follows behind the last block.
  ByteSpan run() {
    for (bool isLast = false; !isLast;) {
      isLast = bits_.take(1) == 1;
      const std::uint32_t kind = bits_.take(2);
      if (kind == 3) failDeflated("deflated data have a block of no known kind");
      if (kind == 0) {
        copyStored();
      } else {
        inflateBlock(kind == 1 ? fixedCodes() : readCodes(bits_));
      }
    }
    if (at_ != out_.size()) failDeflated("deflated data hold fewer bytes than announced");
    return bits_.rest();
  }

 private:
  void checkRoom(std::size_t count) const {
    if (count > out_.size() - at_) failDeflated("deflated data hold more bytes than announced");
  }

  void copyStored() {
    const ByteSpan rest = bits_.rest();
    if (rest.size() < 4) failDeflated("deflated data are cut off");
    const std::size_t length = rest[0] | std::size_t{rest[1]} << 8, check = rest[2] | std::size_t{rest[3]} << 8;
    if (length != (check ^ 0xffff)) failDeflated("deflated data have a stored block of two lengths");
    if (length > rest.size() - 4) failDeflated("deflated data are cut off");
    checkRoom(length);
    std::copy_n(rest.begin() + 4, length, out_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ += length;
    bits_.skipBytes(4 + length);
  }

  void inflateBlock(const BlockCodes& codes) {
    for (;;) {
      bits_.fill();
      const int symbol = codes.literals.decode(bits_);
      if (symbol == 256) return;
      if (symbol < 256) {
        checkRoom(1);
        out_[at_++] = static_cast<std::uint8_t>(symbol);
      } else {
        copyMatch(symbol - 257, codes.distances);
      }
    }
  }

  void copyMatch(int lengthSymbol, const HuffmanCode& distances) {
    if (lengthSymbol >= static_cast<int>(kDeflateLengths.size()))
      failDeflated("deflated data have a match of no length");
    const DeflateRange& lengths = kDeflateLengths[static_cast<std::size_t>(lengthSymbol)];
    const std::size_t length = lengths.base + bits_.take(lengths.extra);
    bits_.fill();
    const int symbol = distances.decode(bits_);
    if (symbol >= static_cast<int>(kDeflateDistances.size())) failDeflated("deflated data have a match of no distance");
    const DeflateRange& range = kDeflateDistances[static_cast<std::size_t>(symbol)];
    const std::size_t distance = range.base + bits_.take(range.extra);
    if (distance > at_) failDeflated("deflated data refer to what is before their start");
    checkRoom(length);
    std::uint8_t* const to = out_.data() + at_;
    const std::uint8_t* const from = to - distance;
    for (std::size_t i = 0; i < length; ++i) to[i] = from[i];  // may overlap
    at_ += length;
  }

  BitReader bits_;
  std::span<std::uint8_t> out_;
  std::size_t at_ = 0;
};

std::uint32_t adler32(std::span<const std::uint8_t> bytes) {
  constexpr std::uint32_t kPrime = 65521;
  constexpr std::size_t kRun = 5552;  // the most bytes before the sums might exceed 32 bits
  std::uint32_t a = 1, b = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    for (const std::size_t end = std::min(bytes.size(), at + kRun); at < end; ++at) {
      a += bytes[at];
      b += a;
    }
    a %= kPrime;
    b %= kPrime;
  }
  return b << 16 | a;
}

}  // namespace

void inflate(ByteSpan packed, std::span<std::uint8_t> out) {
  Inflater(packed, out).run();
}

void inflateZlib(ByteSpan stream, std::span<std::uint8_t> out) {
  if (stream.size() < 6) failDeflated("deflated data are cut off");
  const bool isDeflate = (stream[0] & 15) == 8 && (stream[0] * 256 + stream[1]) % 31 == 0;
  if (!isDeflate || (stream[1] & 32) != 0) failDeflated("deflated data do not start as zlib's do");
  const ByteSpan rest = Inflater(stream.subspan(2), out).run();
  if (rest.size() < 4) failDeflated("deflated data are cut off");
  std::uint32_t expected = 0;
  for (std::size_t i = 0; i < 4; ++i) expected = expected << 8 | rest[i];
  if (expected != adler32(out)) failDeflated("deflated data do not have their checksum");
}

}  // namespace limber
