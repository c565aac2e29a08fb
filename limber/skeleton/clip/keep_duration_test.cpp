#include "limber/skeleton/clip/keep_duration.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(KeepDuration, LastsAsLongAsItsFrames) {
  const std::vector<float> times = {0, 0.5f, 1};
  Clip clip;
  clip.translations.push_back({2, Interpolation::kLinear, {0}, {Vec3f(1, 2, 3)}});
  keepDuration(clip, times);
  EXPECT_EQ(clip.duration(), 1);
  EXPECT_EQ(clip.translations[0].times, times);
  for (const Vec3f& value : clip.translations[0].values) EXPECT_EQ(value, Vec3f(1, 2, 3));
}

TEST(KeepDuration, WhatMovesThatLongStaysAsItIs) {
  Clip clip;
  clip.rotations.push_back({0, Interpolation::kLinear, {0}, {Eigen::Quaternionf::Identity()}});
  clip.translations.push_back({2, Interpolation::kLinear, {0, 1}, {Vec3f(1, 2, 3), Vec3f(1, 2, 4)}});
  keepDuration(clip, {0, 0.5f, 1});
  EXPECT_EQ(clip.rotations[0].times.size(), 1u);
  EXPECT_EQ(clip.translations[0].times.size(), 2u);
  Clip empty;
  keepDuration(empty, {0, 1});
  EXPECT_EQ(empty.duration(), 0);
}

}  // namespace
}  // namespace limber
