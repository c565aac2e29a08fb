#include "limber/motion/limbs/smooth.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Smooth, StepsFromNothingToOneWithoutAKink) {
  EXPECT_EQ(smoothStep(-2), 0);
  EXPECT_EQ(smoothStep(3), 1);
  EXPECT_EQ(smoothStep(0.5), 0.5);
  for (const double end : {0.0, 1.0}) EXPECT_NEAR((smoothStep(end + 1e-6) - smoothStep(end - 1e-6)) / 2e-6, 0, 1e-5);
}

TEST(Smooth, SoftPositiveIsAboveBothOfItsLines) {
  for (double x = -3; x <= 3; x += 0.01) {
    const double more = softPositive(x, 0.2) - std::max(x, 0.0);
    EXPECT_GT(more, 0);
    EXPECT_LE(more, 0.1);
  }
  EXPECT_NEAR((softPositive(1e-6, 0.2) - softPositive(-1e-6, 0.2)) / 2e-6, 0.5, 1e-6);
}

TEST(Smooth, AsinGoesStraightOnWhereItWouldEnd) {
  EXPECT_EQ(straightenedAsin(0.5, 0.9), std::asin(0.5));
  for (const double end : {-0.9, 0.9}) {
    const double inside = (straightenedAsin(end, 0.9) - straightenedAsin(0.99999 * end, 0.9)) / (0.00001 * end);
    EXPECT_NEAR(inside, straightenedAsin(2 * end, 0.9) / end - straightenedAsin(end, 0.9) / end, 1e-3) << end;
  }
}

}  // namespace
}  // namespace limber
