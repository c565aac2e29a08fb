#include "limber/skeleton/clip/moving_scales.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(MovingScales, AreThoseOffTheRestPose) {
  Skeleton skeleton;
  for (const char* name : {"a", "b", "c"}) skeleton.joints.emplace_back().name = name;
  skeleton.joints[1].rest.scale = Vec3(2, 2, 2);
  Clip clip;
  const Vec3f one = Vec3f::Ones(), two = Vec3f::Constant(2), zero = Vec3f::Zero();
  clip.scales.push_back({0, Interpolation::kLinear, {0, 1}, {one, two}});
  clip.scales.push_back({1, Interpolation::kLinear, {0, 1}, {two, two}});
  clip.scales.push_back({2, Interpolation::kCubic, {0}, {zero, one, zero}});
  EXPECT_THAT(jointsWithScales(skeleton, clip), ::testing::ElementsAre(0));
}

}  // namespace
}  // namespace limber
