#include "limber/document/clip/trim_animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "limber/document/gltf/accessor.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::Ge;
using ::testing::Le;
using ::testing::Pointwise;

class TrimAnimation : public ::testing::Test {
 protected:
  void add(const std::string& path, Interpolation interpolation, const std::vector<float>& times,
           const std::vector<float>& values, Index components) {
    gltf::AnimationSampler sampler;
    sampler.input = addFloatAccessor(asset, times, 1);
    sampler.output = addFloatAccessor(asset, values, components);
    sampler.interpolation = interpolation;
    gltf::AnimationChannel channel;
    channel.sampler = static_cast<Index>(animation.samplers.size());
    channel.target.node = 0;
    channel.target.path = path;
    animation.samplers.push_back(std::move(sampler));
    animation.channels.push_back(std::move(channel));
  }

  std::vector<float> times(Index sampler = 0) const { return readFloats(asset, animation.samplers[sampler].input); }
  std::vector<float> values(Index sampler = 0) const { return readFloats(asset, animation.samplers[sampler].output); }

  Asset asset;
  gltf::Animation animation;
};

TEST_F(TrimAnimation, KeysInsideStayAndEndsAreInterpolated) {
  add("weights", Interpolation::kLinear, {0, 1, 2}, {0, 0, 0, 4, 1, 2, 3, 0, 2, 4, 6, 4}, 1);
  animation.channels.push_back(animation.channels[0]);  // both of one sampler
  trimAnimation(asset, animation, {0.5, 1.25});
  EXPECT_THAT(times(), ElementsAre(0, 0.5f, 0.75f));
  EXPECT_THAT(values(), ElementsAre(0.5f, 1, 1.5f, 2, 1, 2, 3, 0, 1.25f, 2.5f, 3.75f, 1));
  EXPECT_THAT(asset.document.accessors[animation.samplers[0].input].max, ElementsAre(0.75));
}

TEST_F(TrimAnimation, StepsStaySteps) {
  add("weights", Interpolation::kStep, {0, 1, 2}, {3, 4, 5}, 1);
  trimAnimation(asset, animation, {0.5, 1.5});
  EXPECT_THAT(times(), ElementsAre(0, 0.5f, 1));
  EXPECT_THAT(values(), ElementsAre(3, 4, 4));
}

TEST_F(TrimAnimation, CurvesKeepTheirShape) {
  // t cubed from 0 to 2: in-tangent, value, out-tangent.
  add("weights", Interpolation::kCubic, {0, 2}, {0, 0, 0, 12, 8, 12}, 1);
  trimAnimation(asset, animation, {1, 2});
  EXPECT_THAT(times(), ElementsAre(0, 1));
  EXPECT_THAT(values(), Pointwise(FloatNear(1e-5f), {3.0f, 1.0f, 3.0f, 12.0f, 8.0f, 12.0f}));
}

TEST_F(TrimAnimation, RotationsTurnAtEvenSpeed) {
  const auto half = static_cast<float>(std::sqrt(0.5));
  add("rotation", Interpolation::kLinear, {0, 3}, {0, 0, 0, 1, half, 0, 0, half}, 4);
  trimAnimation(asset, animation, {0, 1});
  const auto sixth = static_cast<float>(std::acos(-1.0) / 12);  // half of a third of a right angle
  EXPECT_THAT(values(),
              Pointwise(FloatNear(1e-6f), {0.0f, 0.0f, 0.0f, 1.0f, std::sin(sixth), 0.0f, 0.0f, std::cos(sixth)}));
}

TEST_F(TrimAnimation, WhatEndsBeforeStandsStill) {
  add("translation", Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 2, 3}, 3);
  add("weights", Interpolation::kCubic, {0, 1}, {0, 0, 1, 1, 1, 0}, 1);
  trimAnimation(asset, animation, {2, HUGE_VAL});
  EXPECT_THAT(times(), ElementsAre(0));
  EXPECT_THAT(values(), ElementsAre(1, 2, 3));
  EXPECT_EQ(values(1)[1], 1);
}

TEST_F(TrimAnimation, ALoopJoinsWeightsAlone) {
  add("weights", Interpolation::kLinear, {0, 0.5, 1, 2}, {0, 1, 1, 0, 0.5, 0.5, 0.25, 0, 1, 0, 0, 1}, 1);
  add("translation", Interpolation::kLinear, {0, 1}, {0, 0, 0, 1, 2, 3}, 3);
  add("weights", Interpolation::kStep, {0, 1}, {0, 1}, 1);
  add("weights", Interpolation::kCubic, {0, 0.5, 1}, {0, 0.5, 0, 0, 1, 0, 0, 0.5, 0}, 1);  // closed
  loopAnimation(asset, animation, {0, 1});
  const std::vector<float> frames = times(), joined = values();
  EXPECT_FLOAT_EQ(frames.back(), 1);
  ASSERT_EQ(joined.size(), 3 * frames.size());
  EXPECT_THAT(std::vector(joined.end() - 3, joined.end()), ElementsAre(0.125f, 0.5f, 1));
  EXPECT_THAT(std::vector(joined.begin(), joined.begin() + 3), ElementsAre(0.125f, 0.5f, 1));
  EXPECT_THAT(joined, Each(AllOf(Ge(0), Le(1))));
  for (std::size_t v = 3; v < joined.size(); ++v) EXPECT_LT(std::abs(joined[v] - joined[v - 3]), 0.15f) << v;
  EXPECT_THAT(values(1), ElementsAre(0, 0, 0, 1, 2, 3));
  EXPECT_THAT(values(2), ElementsAre(0, 1));
  EXPECT_THAT(values(3), ElementsAre(0, 0.5f, 0, 0, 1, 0, 0, 0.5f, 0));
}

TEST_F(TrimAnimation, KeysOutOfOrderStay) {
  add("weights", Interpolation::kLinear, {1, 0}, {3, 4}, 1);
  trimAnimation(asset, animation, {0.5, 1});
  EXPECT_THAT(times(), ElementsAre(1, 0));
  EXPECT_EQ(asset.warnings.items().size(), 1u);
}

}  // namespace
}  // namespace limber
