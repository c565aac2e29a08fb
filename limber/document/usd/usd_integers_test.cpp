#include "limber/document/usd/usd_integers.h"

#include <limits>

#include <gtest/gtest.h>

#include "limber/document/usd/testing/crate_reader.h"

namespace limber {
namespace {

TEST(UsdIntegers, ComeBackAsTheyWere) {
  constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min(),
                         kMax = std::numeric_limits<std::int32_t>::max();
  std::vector<std::int32_t> steps;  // of all widths, and at their limits
  for (const std::int32_t step : {0, 1, -1, 127, -128, 128, -129, 32767, -32768, 32768, -32769}) {
    steps.push_back(steps.empty() ? step : steps.back() + step);
  }
  for (const std::vector<std::int32_t>& values : std::vector<std::vector<std::int32_t>>{
           {5}, {kMax, kMin, 0, kMin, kMax}, std::vector<std::int32_t>(1001, 3), steps}) {
    EXPECT_EQ(testing::unpackIntegers(packUsdIntegers(values), values.size()), values);
  }
}

TEST(UsdIntegers, EvenStepsTakeNextToNoPlace) {
  std::vector<std::int32_t> values;
  for (std::int32_t i = 0; i < 10000; ++i) values.push_back(3 * i);
  EXPECT_LT(packUsdIntegers(values).size(), 100u);
}

// OpenUSD's own example (pxr/usd/sdf/integerCoding.cpp): 123, 124, 125, 100125, 100125, 100126, 100126.
TEST(UsdIntegers, AreLaidOutAsOpenUsdHasThem) {
  const Bytes packed = packUsdIntegers(std::vector<std::int32_t>{123, 124, 125, 100125, 100125, 100126, 100126});
  const Bytes encoded = testing::decodeLz4Block(ByteSpan(packed).subspan(1));
  EXPECT_EQ(encoded, (Bytes{1, 0, 0, 0, 0b11000001, 0b00010001, 123, 0xa0, 0x86, 0x01, 0, 0, 0}));
}

}  // namespace
}  // namespace limber
