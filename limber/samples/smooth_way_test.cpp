#include "limber/samples/smooth_way.h"

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
