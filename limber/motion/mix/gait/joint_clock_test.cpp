#include "limber/motion/mix/gait/joint_clock.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// Halfway between 2 and 3 steps a second.
TEST(JointClock, StepsASecondAreBlended) {
  const StridePhases phases{GaitPhase({0, 0.5, 1}, 0), GaitPhase({0, 1.0 / 3, 2.0 / 3}, 0), 3, 2};
  JointClock clock(phases, 0);
  for (int i = 0; i < 60; ++i) clock.advance(1.0 / 60, 0.5, 0.5);
  EXPECT_NEAR(clock.phase(), 2.5, 1e-9);
  EXPECT_NEAR(clock.a(), 1.25, 1e-9);
  EXPECT_NEAR(clock.b(), 2.5 / 3, 1e-9);
}

TEST(JointClock, OneMotionTwiceGoesAtItsOwnSpeed) {
  const GaitPhase phase({0, 0.4, 1.1, 1.3}, 0);
  const StridePhases phases{phase, phase, 4, 2};
  JointClock clock(phases, 0.1);
  for (int i = 0; i < 30; ++i) clock.advance(1.0 / 30, 0.3, 0.3);
  EXPECT_NEAR(clock.a(), 1.1, 1e-9);
  EXPECT_NEAR(clock.b(), 1.1, 1e-9);
}

}  // namespace
}  // namespace limber
