#include "limber/document/usd/usd_integers.h"

#include <algorithm>

#include "limber/document/usd/lz4_block.h"

namespace limber {

namespace {

// From one value to the next, modulo 2^32.
std::vector<std::int32_t> differences(std::span<const std::int32_t> values) {
  std::vector<std::int32_t> steps;
  steps.reserve(values.size());
  std::uint32_t before = 0;
  for (const std::int32_t value : values) {
    steps.push_back(static_cast<std::int32_t>(static_cast<std::uint32_t>(value) - before));
    before = static_cast<std::uint32_t>(value);
  }
  return steps;
}

// The greatest of those that are there most often.
std::int32_t commonest(std::vector<std::int32_t> steps) {
  std::sort(steps.begin(), steps.end());
  std::int32_t best = 0;
  std::ptrdiff_t most = 0;
  for (auto from = steps.begin(); from != steps.end();) {
    const auto to = std::upper_bound(from, steps.end(), *from);
    if (to - from >= most) {
      most = to - from;
      best = *from;
    }
    from = to;
  }
  return best;
}

void appendInteger(std::int32_t value, std::size_t size, Bytes& out) {
  for (std::size_t i = 0; i < size; ++i)
    out.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i)));
}

}  // namespace

Bytes packUsdIntegers(std::span<const std::int32_t> values) {
  const std::vector<std::int32_t> steps = differences(values);
  const std::int32_t common = commonest(steps);
  Bytes encoded;
  appendInteger(common, 4, encoded);
  const std::size_t codes = encoded.size();
  encoded.resize(codes + (values.size() + 3) / 4, 0);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::int32_t step = steps[i];
    if (step == common) continue;
    const unsigned code = step == static_cast<std::int8_t>(step) ? 1 : step == static_cast<std::int16_t>(step) ? 2 : 3;
    encoded[codes + i / 4] = static_cast<std::uint8_t>(encoded[codes + i / 4] | code << (2 * (i % 4)));
    appendInteger(step, std::size_t{1} << (code - 1), encoded);
  }
  return packUsdBytes(encoded);
}

Bytes packUsdBytes(ByteSpan bytes) {
  Bytes chunk = encodeLz4Block(bytes);
  chunk.insert(chunk.begin(), 0);  // one chunk
  return chunk;
}

}  // namespace limber
