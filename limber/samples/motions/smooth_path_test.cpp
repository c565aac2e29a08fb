#include "limber/samples/motions/smooth_path.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(SmoothPath, StartsAsAskedAndRestsAtTheEnd) {
  const double h = 1e-4;
  const auto displacement = [](double fraction) { return smoothPath(1.0, -3.0, 7.0, 5.0, fraction); };
  EXPECT_DOUBLE_EQ(displacement(0), 1);
  EXPECT_NEAR((displacement(h) - displacement(-h)) / (2 * h), -3, 1e-5);
  EXPECT_NEAR((displacement(h) - 2 * displacement(0) + displacement(-h)) / (h * h), 7, 1e-3);
  EXPECT_NEAR(displacement(1), 5, 1e-12);
  EXPECT_NEAR((displacement(1 + h) - displacement(1 - h)) / (2 * h), 0, 1e-5);
  EXPECT_NEAR((displacement(1 + h) - 2 * displacement(1) + displacement(1 - h)) / (h * h), 0, 1e-3);
}

TEST(SmoothPath, JoinsTwoKnots) {
  const double h = 1e-4;
  const Knot<double> from{1, -3, 7}, to{5, 2, -4};
  const auto displacement = [&](double time) { return between(from, to, 2, time); };
  EXPECT_NEAR(displacement(0), 1, 1e-12);
  EXPECT_NEAR(displacement(2), 5, 1e-12);
  EXPECT_NEAR((displacement(h) - displacement(-h)) / (2 * h), -3, 1e-5);
  EXPECT_NEAR((displacement(2 + h) - displacement(2 - h)) / (2 * h), 2, 1e-5);
  EXPECT_NEAR((displacement(2 + h) - 2 * displacement(2) + displacement(2 - h)) / (h * h), -4, 1e-3);
}

TEST(SmoothPath, ABounceFliesFreely) {
  const double period = 0.5, ground = 0.6, air = 0.4 * period;
  EXPECT_NEAR(bounceHeight(0, ground, period), 0, 1e-12);
  EXPECT_NEAR(bounceHeight(0.8, ground, period), kGravity * air * air / 8, 1e-12) << "highest in the middle";
  EXPECT_LT(bounceHeight(0.3, ground, period), -0.01) << "pressed down";
  EXPECT_NEAR(bounceHeight(0.5999, ground, period), bounceHeight(0.6001, ground, period), 1e-3);
}

TEST(SmoothPath, RisesAndBumpsStayInTheirRange) {
  EXPECT_EQ(smoothRise(-1), 0);
  EXPECT_EQ(smoothRise(0.5), 0.5);
  EXPECT_EQ(smoothRise(2), 1);
  EXPECT_EQ(smoothBump(0), 0);
  EXPECT_EQ(smoothBump(0.5), 1);
  EXPECT_EQ(smoothBump(1.2), 0);
  EXPECT_NEAR(smoothBump(0.2), smoothBump(0.8), 1e-12);
}

}  // namespace
}  // namespace limber
