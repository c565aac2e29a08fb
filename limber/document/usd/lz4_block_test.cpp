#include "limber/document/usd/lz4_block.h"

#include <gtest/gtest.h>

#include "limber/document/usd/testing/crate_reader.h"

namespace limber {
namespace {

Bytes noise(std::size_t size) {
  Bytes bytes;
  for (std::uint32_t state = 1; bytes.size() < size; state = state * 1664525 + 1013904223) bytes.push_back(state >> 24);
  return bytes;
}

TEST(Lz4Block, ComesBackAsItWas) {
  std::vector<Bytes> all = {{}, {7}, Bytes(12, 0), Bytes(13, 0), Bytes(100000, 3), noise(15), noise(70000)};
  Bytes repeated = noise(300);
  for (int i = 0; i < 400; ++i) repeated.insert(repeated.end(), repeated.begin() + i, repeated.begin() + i + 270);
  all.push_back(repeated);
  for (const Bytes& bytes : all) {
    EXPECT_EQ(testing::decodeLz4Block(encodeLz4Block(bytes)), bytes) << bytes.size();
  }
}

TEST(Lz4Block, RepeatedBytesTakeNextToNoPlaceAndOthersHardlyMore) {
  EXPECT_LT(encodeLz4Block(Bytes(100000, 3)).size(), 500u);
  EXPECT_LT(encodeLz4Block(noise(70000)).size(), 70000u + 70000u / 255 + 16);
}

// What decoders take for granted: the last five bytes are literals, and the last match begins twelve before the end.
TEST(Lz4Block, EndsWithLiterals) {
  const Bytes block = encodeLz4Block(Bytes(1000, 9));
  EXPECT_GE(block[block.size() - 6] >> 4, 5);
}

}  // namespace
}  // namespace limber
