#include "limber/limbs/near_ground.h"

#include <gtest/gtest.h>

#include <array>

namespace limber {
namespace {

double riseOf(double source, double target) {
  const std::array<SolePoint, 1> point = {{{source, target}}};
  return riseNearGround(point);
}

double nearOf(double one, double other) {
  const std::array<SolePoint, 2> points = {{{one, 0}, {other, 0}}};
  return nearGround(points);
}

TEST(NearGround, FeetAreAsHighAsTheSourcesWhereThatIsLow) {
  EXPECT_NEAR(riseOf(0, 0.1), -0.1, 0.002);
  EXPECT_NEAR(riseOf(0, -0.1), 0.1, 0.002);
  EXPECT_NEAR(riseOf(0.03, 0.1), -0.07, 0.002);
  EXPECT_EQ(riseOf(0.7, 0.3), 0) << "far up the joint angles tell";
  const double half = riseOf(0.31, 0.41);
  EXPECT_LT(half, -0.03);
  EXPECT_GT(half, -0.07);
  EXPECT_NEAR(riseOf(-0.1, 0.1), -0.1, 0.002) << "not below the ground";
}

TEST(NearGround, ThePointThatIsLowCounts) {
  const std::array<SolePoint, 2> onToes = {{{0.58, 0.2}, {0, 0.05}}};
  EXPECT_NEAR(riseNearGround(onToes), -0.05, 0.003);
  EXPECT_EQ(nearOf(0, 0.7), 1);
  EXPECT_EQ(nearOf(0.7, 0), 1);
  EXPECT_EQ(nearOf(0.7, 0.7), 0);
}

TEST(NearGround, ComesWithoutAKink) {
  constexpr double kStep = 1e-3;
  for (double height = -0.1; height < 0.7; height += kStep) {
    const auto bend = [&](auto&& f) { return f(height - kStep) - 2 * f(height) + f(height + kStep); };
    EXPECT_LT(std::abs(bend([](double h) { return riseOf(h, 0.1); })), 5e-4) << height;
    EXPECT_LT(std::abs(bend([](double h) { return nearOf(h, 0.7); })), 1e-3) << height;
    EXPECT_LT(std::abs(bend(heldHeight)), 1e-4) << height;
  }
}

TEST(NearGround, WhatTremblesIsHeldOnTheGround) {
  EXPECT_LT(heldHeight(-0.02), 0.001);
  EXPECT_LT(heldHeight(0.01), 0.002);
  EXPECT_NEAR(heldHeight(0.2), 0.17, 0.001);
}

}  // namespace
}  // namespace limber
