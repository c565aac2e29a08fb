#include "limber/core/file/deflate.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "limber/core/file/deflate_ranges.h"

namespace limber {

namespace {

constexpr std::size_t kWindow = 32768, kShortest = 4, kLongest = 258;
constexpr std::size_t kBlockTokens = 32768;
constexpr int kMaxTries = 16;  // earlier positions tried for one match
constexpr std::size_t kLiterals = 286, kDistances = 30, kCodeLengths = 19, kEndOfBlock = 256;
constexpr std::uint32_t kNowhere = 0xffffffff;

template <std::size_t kCount>
std::size_t symbolOf(const std::array<DeflateRange, kCount>& ranges, std::size_t value) {
  const auto after =
      std::upper_bound(ranges.begin(), ranges.end(), value,
                       [](std::size_t wanted, const DeflateRange& range) { return wanted < range.base; });
  return static_cast<std::size_t>(after - ranges.begin()) - 1;
}

// A literal (distance 0), or a match.
struct Token {
  std::uint16_t value = 0;  // the byte, or the length
  std::uint16_t distance = 0;
};

// Code lengths of a Huffman code, none above `most`; 0 for symbols that do not occur.
std::vector<std::uint8_t> codeLengths(std::span<const std::uint32_t> counts, int most) {
  std::vector<std::size_t> symbols;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) symbols.push_back(s);
  }
  std::vector<std::uint8_t> lengths(counts.size(), 0);
  if (symbols.empty()) return lengths;
  if (symbols.size() == 1) {
    lengths[symbols[0]] = 1;
    return lengths;
  }
  std::stable_sort(symbols.begin(), symbols.end(), [&](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });

  // The tree: leaves in order of their counts, then the nodes above them, which are made in that order, too.
  const std::size_t leaves = symbols.size();
  std::vector<std::uint64_t> weights(2 * leaves - 1);
  std::vector<std::size_t> parent(2 * leaves - 1);
  for (std::size_t i = 0; i < leaves; ++i) weights[i] = counts[symbols[i]];
  std::size_t leaf = 0, inner = leaves;
  for (std::size_t made = leaves; made < weights.size(); ++made) {
    for (int child = 0; child < 2; ++child) {
      const bool isLeaf = leaf < leaves && (inner >= made || weights[leaf] <= weights[inner]);
      const std::size_t taken = isLeaf ? leaf++ : inner++;
      weights[made] += weights[taken];
      parent[taken] = made;
    }
  }
  std::vector<int> depth(weights.size(), 0);
  for (std::size_t i = weights.size() - 1; i-- > 0;) depth[i] = depth[parent[i]] + 1;

  // Codes that are too long become as long as may be, which others make room for; `used` is Kraft's sum in units of
  // the longest code.
  const std::uint64_t whole = std::uint64_t{1} << most;
  std::uint64_t used = 0;
  for (std::size_t i = 0; i < leaves; ++i) {
    lengths[symbols[i]] = static_cast<std::uint8_t>(std::min(depth[i], most));
    used += whole >> lengths[symbols[i]];
  }
  while (used > whole) {
    std::size_t longest = leaves;
    for (std::size_t i = 0; i < leaves; ++i) {
      const bool canGrow = lengths[symbols[i]] < most;
      if (canGrow && (longest == leaves || lengths[symbols[i]] > lengths[symbols[longest]])) longest = i;
    }
    used -= whole >> ++lengths[symbols[longest]];
  }
  for (std::size_t i = leaves; i-- > 0 && used < whole;) {  // the most frequent first
    while (used + (whole >> lengths[symbols[i]]) <= whole) used += whole >> lengths[symbols[i]]--;
  }
  return lengths;
}

// The codes of those lengths, their bits in the order of the stream (RFC 1951, 3.2.2).
std::vector<std::uint16_t> codesOf(const std::vector<std::uint8_t>& lengths) {
  std::array<std::uint32_t, 17> count{}, next{};
  for (const std::uint8_t length : lengths) ++count[length];
  count[0] = 0;
  for (std::size_t bits = 1; bits <= 15; ++bits) next[bits] = (next[bits - 1] + count[bits - 1]) << 1;
  std::vector<std::uint16_t> codes(lengths.size(), 0);
  for (std::size_t s = 0; s < lengths.size(); ++s) {
    if (lengths[s] == 0) continue;
    std::uint32_t code = next[lengths[s]]++;
    for (int bit = 0; bit < lengths[s]; ++bit, code >>= 1) {
      codes[s] = static_cast<std::uint16_t>(codes[s] << 1 | (code & 1));
    }
  }
  return codes;
}

struct Huffman {
  Huffman(std::span<const std::uint32_t> counts, int most)
      : lengths(codeLengths(counts, most)), codes(codesOf(lengths)) {}

  std::vector<std::uint8_t> lengths;
  std::vector<std::uint16_t> codes;
};

class Deflater {
 public:
  explicit Deflater(ByteSpan data) : data_(data) {}

  Bytes deflate() {
    out_ = {0x78, 0x9c};
    head_.assign(std::size_t{1} << 15, kNowhere);
    previous_.assign(kWindow, kNowhere);
    std::size_t at = 0;
    do {
      tokens_.clear();
      while (at < data_.size() && tokens_.size() < kBlockTokens) at += addToken(at);
      writeBlock(at == data_.size());
    } while (at < data_.size());
    if (bitCount_ > 0) out_.push_back(static_cast<std::uint8_t>(bits_));
    const std::uint32_t sum = checksum();
    for (int shift = 24; shift >= 0; shift -= 8) out_.push_back(static_cast<std::uint8_t>(sum >> shift));
    return std::move(out_);
  }

 private:
  std::size_t hashAt(std::size_t at) const {
    const std::uint32_t four =
        data_[at] | data_[at + 1] << 8 | data_[at + 2] << 16 | std::uint32_t{data_[at + 3]} << 24;
    return (four * 2654435761u) >> 17;
  }

  // Makes the position known to later ones; returns the one before it that began alike.
  std::uint32_t remember(std::size_t at) {
    if (at + kShortest > data_.size()) return kNowhere;
    std::uint32_t& head = head_[hashAt(at)];
    previous_[at % kWindow] = head;
    return std::exchange(head, static_cast<std::uint32_t>(at));
  }

  std::size_t matchLength(std::size_t from, std::size_t at) const {
    const std::size_t most = std::min(kLongest, data_.size() - at);
    std::size_t length = 0;
    while (length < most && data_[from + length] == data_[at + length]) ++length;
    return length;
  }

  // Returns how many bytes the token covers.
  std::size_t addToken(std::size_t at) {
    std::size_t length = 1, distance = 0;
    std::uint32_t from = remember(at);
    for (int tries = 0; tries < kMaxTries && from != kNowhere && at - from < kWindow; ++tries) {
      const std::size_t found = matchLength(from, at);
      if (found >= kShortest && found > length) {
        length = found;
        distance = at - from;
      }
      from = previous_[from % kWindow];
    }
    for (std::size_t i = 1; i < length; ++i) remember(at + i);
    tokens_.push_back(
        {static_cast<std::uint16_t>(distance > 0 ? length : data_[at]), static_cast<std::uint16_t>(distance)});
    return length;
  }

  void putBits(std::uint32_t value, int count) {
    bits_ |= std::uint64_t{value} << bitCount_;
    for (bitCount_ += count; bitCount_ >= 8; bitCount_ -= 8, bits_ >>= 8)
      out_.push_back(static_cast<std::uint8_t>(bits_));
  }

  void put(const Huffman& huffman, std::size_t symbol) { putBits(huffman.codes[symbol], huffman.lengths[symbol]); }

  void writeBlock(bool isLast) {
    std::array<std::uint32_t, kLiterals> literals{};
    std::array<std::uint32_t, kDistances> distances{};
    for (const Token& token : tokens_) {
      ++literals[token.distance == 0 ? token.value : 257 + symbolOf(kDeflateLengths, token.value)];
      if (token.distance > 0) ++distances[symbolOf(kDeflateDistances, token.distance)];
    }
    literals[kEndOfBlock] = 1;
    const Huffman literal(literals, 15), distance(distances, 15);
    putBits(isLast, 1);
    putBits(2, 2);
    writeCodes(literal.lengths, distance.lengths);
    for (const Token& token : tokens_) {
      if (token.distance == 0) {
        put(literal, token.value);
        continue;
      }
      const std::size_t length = symbolOf(kDeflateLengths, token.value);
      put(literal, 257 + length);
      putBits(std::uint32_t{token.value} - kDeflateLengths[length].base, kDeflateLengths[length].extra);
      const std::size_t away = symbolOf(kDeflateDistances, token.distance);
      put(distance, away);
      putBits(std::uint32_t{token.distance} - kDeflateDistances[away].base, kDeflateDistances[away].extra);
    }
    put(literal, kEndOfBlock);
  }

  // The lengths of both codes, themselves coded; runs of zeros as one symbol (17: up to 10, 18: up to 138).
  void writeCodes(const std::vector<std::uint8_t>& literal, const std::vector<std::uint8_t>& distance) {
    std::vector<std::uint8_t> lengths(literal);
    lengths.insert(lengths.end(), distance.begin(), distance.end());
    std::vector<std::pair<std::uint8_t, std::uint8_t>> symbols;  // and the value behind it
    for (std::size_t i = 0; i < lengths.size();) {
      std::size_t zeros = 0;
      while (i + zeros < lengths.size() && lengths[i + zeros] == 0 && zeros < 138) ++zeros;
      if (zeros >= 3)
        symbols.emplace_back(zeros > 10 ? 18 : 17, zeros - (zeros > 10 ? 11 : 3));
      else
        symbols.emplace_back(lengths[i], 0);
      i += zeros >= 3 ? zeros : 1;
    }
    std::array<std::uint32_t, kCodeLengths> counts{};
    for (const auto& [symbol, behind] : symbols) ++counts[symbol];
    const Huffman code(counts, 7);
    putBits(kLiterals - 257, 5);
    putBits(kDistances - 1, 5);
    putBits(kCodeLengths - 4, 4);
    for (const int symbol : {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15}) {
      putBits(code.lengths[static_cast<std::size_t>(symbol)], 3);
    }
    for (const auto& [symbol, behind] : symbols) {
      put(code, symbol);
      if (symbol >= 17) putBits(behind, symbol == 17 ? 3 : 7);
    }
  }

  // Adler-32 (RFC 1950).
  std::uint32_t checksum() const {
    constexpr std::uint32_t kBase = 65521;
    constexpr std::size_t kBeforeOverflow = 5552;
    std::uint32_t a = 1, b = 0;
    for (std::size_t i = 0; i < data_.size();) {
      for (const std::size_t end = std::min(data_.size(), i + kBeforeOverflow); i < end; ++i) b += a += data_[i];
      a %= kBase;
      b %= kBase;
    }
    return b << 16 | a;
  }

  ByteSpan data_;
  Bytes out_;
  std::vector<std::uint32_t> head_, previous_;  // by hash; by position in the window
  std::vector<Token> tokens_;
  std::uint64_t bits_ = 0;
  int bitCount_ = 0;
};

}  // namespace

Bytes deflateZlib(ByteSpan data) {
  return Deflater(data).deflate();
}

}  // namespace limber
