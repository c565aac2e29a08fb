#include "limber/core/random.h"

#include <gtest/gtest.h>

namespace limber {

TEST(Random, DrawsTheNumbersOfSplitMix64) {
  Random random(1234567);  // first outputs of the published generator
  EXPECT_EQ(random.bits(), 6457827717110365317ULL);
  EXPECT_EQ(random.bits(), 3203168211198807973ULL);
  EXPECT_EQ(random.bits(), 9817491932198370423ULL);
}

TEST(Random, HasTheMomentsItSays) {
  Random random(3);
  constexpr int kDraws = 100000;
  double mean = 0, square = 0, even = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.normal();
    mean += x / kDraws;
    square += x * x / kDraws;
    even += random.uniform() / kDraws;
  }
  EXPECT_NEAR(mean, 0, 0.015);
  EXPECT_NEAR(square, 1, 0.02);
  EXPECT_NEAR(even, 0.5, 0.005);
}

}  // namespace limber
