#include "limber/motion/limbs/contacts/plant_detector.h"

#include <cmath>

#include <gtest/gtest.h>

namespace limber {
namespace {

// Of a point that goes along the ground at `speed`, and shakes by `tremble` from frame to frame, all in hip heights.
double plantedFraction(double framesPerSecond, double speed, double tremble, double height = 0) {
  constexpr double kHip = 0.9;
  PlantDetector detector(kHip);
  double planted = 0, count = 0;
  const int frames = static_cast<int>(framesPerSecond);
  for (int f = 0; f < frames; ++f) {
    const double x = speed * f / framesPerSecond + (f % 2 == 0 ? 0 : tremble);
    planted += detector.next(kHip * Vec3(x, height, 0), kHip * height, f == 0 ? 0 : 1 / framesPerSecond);
    ++count;
  }
  return planted / count;
}

TEST(PlantDetector, StandsWhileSlowAndLow) {
  for (const double rate : {24.0, 30.0, 60.0, 100.0, 120.0, 240.0}) {
    EXPECT_EQ(plantedFraction(rate, 0.1, 0), 1) << rate;
    EXPECT_LT(plantedFraction(rate, 0.8, 0), 0.1) << rate;
    EXPECT_EQ(plantedFraction(rate, 0.1, 0, 0.2), 0) << rate;
  }
}

TEST(PlantDetector, SeesThroughTrembling) {
  // 0.003 hip heights from frame to frame is 0.36 a second at 120 frames a second: more than a planted foot moves.
  EXPECT_EQ(plantedFraction(120, 0, 0.003), 1);
}

TEST(PlantDetector, ForgetsWhenTold) {
  PlantDetector detector(1);
  EXPECT_TRUE(detector.next(Vec3(0, 0, 0), 0, 0));
  EXPECT_FALSE(detector.next(Vec3(5, 0, 0), 0, 0.03)) << "a jump";
  detector.reset();
  EXPECT_TRUE(detector.next(Vec3(9, 0, 0), 0, 0.03)) << "as if it was the first frame";
}

TEST(PlantDetector, LeavesLaterThanItEnters) {
  PlantDetector slow(1), standing(1);
  for (int f = 0; f < 10; ++f) standing.next(Vec3::Zero(), 0, 0.03);
  bool entered = false, stayed = true;
  for (int f = 0; f < 10; ++f) {
    const Vec3 position(0.4 * 0.03 * f, 0, 0);
    // The first frame of one counts as unmoved, so let it be off the ground.
    entered = slow.next(position, f == 0 ? 1 : 0, 0.03) || entered;
    stayed = standing.next(position, 0, 0.03) && stayed;
  }
  EXPECT_FALSE(entered);
  EXPECT_TRUE(stayed);
}

}  // namespace
}  // namespace limber
