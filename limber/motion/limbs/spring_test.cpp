#include "limber/motion/limbs/spring.h"

#include <gtest/gtest.h>

#include "limber/core/types.h"

namespace limber {
namespace {

// Small steps of the spring's own equation: x'' = rate^2 (wanted - x) - 2 rate x'.
double simulated(double wanted, double rate, double seconds, double value, double speed) {
  constexpr int kSteps = 200000;
  const double step = seconds / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    speed += step * (rate * rate * (wanted - value) - 2 * rate * speed);
    value += step * speed;
  }
  return value;
}

TEST(Spring, MovesAsItsEquationSays) {
  for (const double rate : {3.0, 20.0}) {
    double value = 2, speed = -5;
    springTo(0.5, rate, 0.1, value, speed);
    EXPECT_NEAR(value, simulated(0.5, rate, 0.1, 2, -5), 1e-3);
  }
}

TEST(Spring, StepsAddUp) {
  Vec3 one(1, -2, 3), oneSpeed(0, 4, -1), many = one, manySpeed = oneSpeed;
  const Vec3 wanted(0.5, 0, 1);
  springTo(wanted, 8.0, 0.3, one, oneSpeed);
  for (int i = 0; i < 30; ++i) springTo(wanted, 8.0, 0.01, many, manySpeed);
  EXPECT_LT((one - many).norm() + (oneSpeed - manySpeed).norm(), 1e-12);
}

TEST(Spring, ComesToRestWithoutSwingingOver) {
  double value = 1, speed = 0;
  for (int i = 0; i < 200; ++i) {
    const double before = value;
    springTo(0.0, 12.0, 0.01, value, speed);
    ASSERT_LT(value, before);
    ASSERT_GT(value, 0);
  }
  EXPECT_LT(value, 1e-8);
}

}  // namespace
}  // namespace limber
