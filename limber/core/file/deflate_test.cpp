#include "limber/core/file/deflate.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <zlib.h>

#include "limber/core/random.h"

namespace limber {
namespace {

// What zlib makes of a stream.
Bytes inflated(const Bytes& stream, std::size_t size) {
  Bytes data(size + 1);
  uLongf length = data.size();
  if (uncompress(data.data(), &length, stream.data(), stream.size()) != Z_OK) return {};
  data.resize(length);
  return data;
}

void expectComesBack(const Bytes& data) {
  ASSERT_EQ(inflated(deflateZlib(data), data.size()), data) << data.size() << " bytes";
}

TEST(DeflateZlib, EveryLengthUpToAFewMatches) {
  Bytes data;
  for (int i = 0; i < 1200; ++i) {
    expectComesBack(data);
    data.push_back(static_cast<std::uint8_t>(i % 7 * (i % 300 > 200)));
  }
}

TEST(DeflateZlib, NoiseAndRepetition) {
  Random random(1);
  for (const int kinds : {1, 2, 3, 40, 256}) {
    Bytes data;
    for (int i = 0; i < 100000; ++i) data.push_back(static_cast<std::uint8_t>(random.below(kinds)));
    expectComesBack(data);
  }
}

TEST(DeflateZlib, MatchesOfEveryDistance) {
  Random random(2);
  for (std::size_t distance = 1; distance < 40000; distance = distance * 3 / 2 + 1) {
    Bytes data;
    for (std::size_t i = 0; i < distance; ++i) data.push_back(static_cast<std::uint8_t>(random.below(256)));
    for (std::size_t i = 0; i < 2000; ++i) data.push_back(data[data.size() - distance]);
    expectComesBack(data);
  }
}

// Counts like Fibonacci's numbers make codes as deep as there are symbols; 15 bits are allowed.
TEST(DeflateZlib, CodesThatWouldBeTooLong) {
  Bytes data;
  std::size_t count = 1, before = 1;
  for (std::uint8_t symbol = 0; symbol < 24; ++symbol) {
    data.insert(data.end(), count, symbol);
    before = std::exchange(count, count + before);
  }
  Random random(3);
  for (std::size_t i = data.size(); i-- > 1;) std::swap(data[i], data[random.below(i + 1)]);
  expectComesBack(data);
}

TEST(DeflateZlib, CoordinatesAreAboutAsShortAsByZlib) {
  Random random(4);
  Bytes data;
  for (int i = 0; i < 30000; ++i) {
    const double value = static_cast<float>(std::sin(i * 0.01) + 1e-3 * random.uniform());
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    data.insert(data.end(), bytes, bytes + sizeof(value));
  }
  uLongf length = compressBound(data.size());
  Bytes byZlib(length);
  ASSERT_EQ(compress(byZlib.data(), &length, data.data(), data.size()), Z_OK);
  EXPECT_LT(deflateZlib(data).size(), 1.05 * length);
  expectComesBack(data);
}

}  // namespace
}  // namespace limber
