#include "limber/samples/motions/smooth_way.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(SmoothWay, StartsAsAskedAndRestsAtTheEnd) {
  const double h = 1e-4;
  const auto way = [](double share) { return smoothWay(1.0, -3.0, 7.0, 5.0, share); };
  EXPECT_DOUBLE_EQ(way(0), 1);
  EXPECT_NEAR((way(h) - way(-h)) / (2 * h), -3, 1e-5);
  EXPECT_NEAR((way(h) - 2 * way(0) + way(-h)) / (h * h), 7, 1e-3);
  EXPECT_NEAR(way(1), 5, 1e-12);
  EXPECT_NEAR((way(1 + h) - way(1 - h)) / (2 * h), 0, 1e-5);
  EXPECT_NEAR((way(1 + h) - 2 * way(1) + way(1 - h)) / (h * h), 0, 1e-3);
}

TEST(SmoothWay, JoinsTwoKnots) {
  const double h = 1e-4;
  const Knot<double> from{1, -3, 7}, to{5, 2, -4};
  const auto way = [&](double time) { return between(from, to, 2, time); };
  EXPECT_NEAR(way(0), 1, 1e-12);
  EXPECT_NEAR(way(2), 5, 1e-12);
  EXPECT_NEAR((way(h) - way(-h)) / (2 * h), -3, 1e-5);
  EXPECT_NEAR((way(2 + h) - way(2 - h)) / (2 * h), 2, 1e-5);
  EXPECT_NEAR((way(2 + h) - 2 * way(2) + way(2 - h)) / (h * h), -4, 1e-3);
}

TEST(SmoothWay, ABounceFliesFreely) {
  const double period = 0.5, ground = 0.6, air = 0.4 * period;
  EXPECT_NEAR(bounceHeight(0, ground, period), 0, 1e-12);
  EXPECT_NEAR(bounceHeight(0.8, ground, period), kGravity * air * air / 8, 1e-12) << "highest in the middle";
  EXPECT_LT(bounceHeight(0.3, ground, period), -0.01) << "pressed down";
  EXPECT_NEAR(bounceHeight(0.5999, ground, period), bounceHeight(0.6001, ground, period), 1e-3);
}

TEST(SmoothWay, RisesAndBumpsStayInTheirRange) {
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
