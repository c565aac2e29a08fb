#include "limber/motion/mix/gait/gait_phase.h"

#include <gtest/gtest.h>

#include <cmath>

namespace limber {
namespace {

TEST(GaitPhase, GoesThroughItsKnotsAndStraightOnBeyond) {
  const GaitPhase phase({1, 1.5, 2.5, 2.75}, 3);
  EXPECT_NEAR(phase.at(1), 3, 1e-12);
  EXPECT_NEAR(phase.at(1.5), 4, 1e-12);
  EXPECT_NEAR(phase.at(2.75), 6, 1e-12);
  EXPECT_NEAR(phase.at(0.5), 2, 1e-12);   // a step takes half a second there
  EXPECT_NEAR(phase.at(3.25), 8, 1e-12);  // and a quarter here
}

TEST(GaitPhase, RisesSmoothlyWhateverTheSteps) {
  const GaitPhase phase({0, 0.1, 2, 2.05, 2.1, 5}, 0);
  double before = phase.at(-1);
  for (double t = -0.99; t < 6; t += 0.01) {
    EXPECT_GT(phase.at(t), before) << t;
    EXPECT_GT(phase.rate(t), 0) << t;
    EXPECT_NEAR(phase.rate(t), (phase.at(t + 1e-6) - phase.at(t - 1e-6)) / 2e-6, 1e-3) << t;
    before = phase.at(t);
  }
}

TEST(GaitPhase, WhenIsTheInverse) {
  const GaitPhase phase({0, 0.1, 2, 2.05, 2.1, 5}, -2);
  for (double t = -1; t < 6; t += 0.037) EXPECT_NEAR(phase.when(phase.at(t)), t, 1e-9);
}

TEST(GaitPhase, EvenStepsGoEvenly) {
  const GaitPhase phase({0.3, 0.8, 1.3, 1.8}, 0);
  for (double t = 0; t < 2; t += 0.01) EXPECT_NEAR(phase.rate(t), 2, 1e-12);
}

}  // namespace
}  // namespace limber
