#include "limber/motion/retarget/displacement_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace limber {
namespace {

constexpr double kFrameSeconds = 1.0 / 60;

// The largest third difference, but for those across `cut`.
double roughness(const std::vector<double>& x, std::size_t cut = 0) {
  double worst = 0;
  for (std::size_t f = 3; f < x.size(); ++f) {
    if (f >= cut && f < cut + 3) continue;
    worst = std::max(worst, std::abs(x[f] - 3 * x[f - 1] + 3 * x[f - 2] - x[f - 3]));
  }
  return worst;
}

TEST(DisplacementCurve, NothingAskedChangesNothing) {
  for (const std::size_t frames : {1, 2, 3, 50}) {
    for (const double value : displacementCurve(std::vector<CurveGoal>(frames), kFrameSeconds)) EXPECT_EQ(value, 0);
  }
}

TEST(DisplacementCurve, ReachesWhatCountsAndFadesSmoothly) {
  std::vector<CurveGoal> goals(201);
  goals[100].value = 0.3;
  goals[100].valueWeight = 1e9;
  const std::vector<double> curve = displacementCurve(goals, kFrameSeconds);
  EXPECT_NEAR(curve[100], 0.3, 1e-5);
  EXPECT_NEAR(curve[5], 0, 0.003);
  EXPECT_NEAR(curve[90], curve[110], 1e-9);
  EXPECT_LT(roughness(curve), 0.01);
}

// A foot at rest in the middle of a motion: its position is free, so it lies where both sides are least changed.
TEST(DisplacementCurve, StepsAreHeldAndThePlaceIsFree) {
  std::vector<CurveGoal> goals(120);
  double moved = 0;
  for (std::size_t f = 41; f < 80; ++f) {
    goals[f].step = 0.002 * std::sin(0.9 * static_cast<double>(f)) - 0.001;
    goals[f].stepWeight = 1e9;
    moved += goals[f].step;
  }
  const std::vector<double> curve = displacementCurve(goals, kFrameSeconds, {0.05});
  for (std::size_t f = 41; f < 80; ++f) EXPECT_NEAR(curve[f] - curve[f - 1], goals[f].step, 1e-4);
  EXPECT_NEAR(curve[40], -moved / 2, 0.2 * std::abs(moved));
  EXPECT_NEAR(curve[79], moved / 2, 0.2 * std::abs(moved));
}

TEST(DisplacementCurve, StaysAboveItsBoundAndTouchesItOnlyWhereItHasTo) {
  std::vector<CurveGoal> goals(200);
  for (std::size_t f = 0; f < goals.size(); ++f) {
    goals[f].least = 0.1 * std::sin(0.1 * static_cast<double>(f)) + 0.01 * std::sin(2.0 * static_cast<double>(f));
  }
  const std::vector<double> curve = displacementCurve(goals, kFrameSeconds, {0.1, 1, 1e9});
  double closest = 1;
  for (std::size_t f = 0; f < goals.size(); ++f) {
    EXPECT_GT(curve[f], goals[f].least - 1e-4);
    closest = std::min(closest, curve[f] - goals[f].least);
    // In the troughs nothing keeps it down.
    if (goals[f].least < -0.08) {
      EXPECT_GT(curve[f], goals[f].least + 0.01);
    }
  }
  EXPECT_LT(closest, 1e-4);
}

TEST(DisplacementCurve, NothingGoesOnAcrossACut) {
  std::vector<CurveGoal> goals(100);
  goals[50].cut = true;
  goals[49].value = 1;
  goals[49].valueWeight = 1e9;
  const std::vector<double> curve = displacementCurve(goals, kFrameSeconds);
  EXPECT_NEAR(curve[49], 1, 1e-5);
  for (std::size_t f = 50; f < goals.size(); ++f) EXPECT_NEAR(curve[f], 0, 1e-12);
}

// Rounding must not win over the pull.
TEST(DisplacementCurve, ManyFramesASecondAreSolved) {
  std::vector<CurveGoal> goals(4000);
  for (std::size_t f = 1000; f < 3000; ++f) {
    goals[f].value = 0.1;
    goals[f].valueWeight = 1e6;
  }
  const std::vector<double> curve = displacementCurve(goals, 1.0 / 2000);
  EXPECT_NEAR(curve[2000], 0.1, 1e-4);
  EXPECT_NEAR(curve[0], 0, 0.01);
}

}  // namespace
}  // namespace limber
