#include "limber/preview/image/texture.h"

#include <limits>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/preview/image/palette.h"

namespace limber {
namespace {

// Pixels of grey bytes.
Image grey(int width, int height, const std::vector<int>& values) {
  Image image{width, height, {}};
  for (const int value : values) image.pixels.insert(image.pixels.end(), 3, static_cast<std::uint8_t>(value));
  return image;
}

double linear(int value) {
  return linearFromSrgb(value, value, value).x();
}

TEST(Texture, ThePixelsMiddleHasItsColor) {
  const Texture texture({2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}}, TextureWrap::kRepeat,
                        TextureWrap::kRepeat);
  EXPECT_TRUE(texture.sample({0.25f, 0.25f}, 0).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE(texture.sample({0.75f, 0.25f}, 0).isApprox(Vec3(0, 1, 0)));  // u goes to the right
  EXPECT_TRUE(texture.sample({0.25f, 0.75f}, 0).isApprox(Vec3(0, 0, 1)));  // v goes down
}

TEST(Texture, BetweenPixelsLightIsMixed) {
  const Texture texture(grey(2, 1, {40, 200}), TextureWrap::kClamp, TextureWrap::kClamp);
  EXPECT_NEAR(texture.sample({0.5f, 0.5f}, 0).x(), 0.5 * (linear(40) + linear(200)), 1e-6);
  EXPECT_NEAR(texture.sample({0.375f, 0.5f}, 0).x(), 0.75 * linear(40) + 0.25 * linear(200), 1e-6);
}

TEST(Texture, WrapsAsTheSamplerSays) {
  const Image image = grey(4, 1, {10, 80, 160, 250});
  const auto at = [&](TextureWrap wrap, float u) {
    return srgbByte(Texture(image, wrap, wrap).sample({u, 0.5f}, 0).x());
  };
  for (const float turns : {-3.0f, 0.0f, 5.0f}) EXPECT_EQ(at(TextureWrap::kRepeat, turns + 0.375f), 80);
  EXPECT_EQ(at(TextureWrap::kMirror, 1.125f), 250);
  EXPECT_EQ(at(TextureWrap::kMirror, -0.375f), 80);
  EXPECT_EQ(at(TextureWrap::kMirror, 2.375f), 80);
  EXPECT_EQ(at(TextureWrap::kClamp, 7), 250);
  EXPECT_EQ(at(TextureWrap::kClamp, -7), 10);
}

TEST(Texture, SmallerLevelsAreMeansOfLight) {
  const Texture texture(grey(2, 2, {0, 0, 255, 255}), TextureWrap::kRepeat, TextureWrap::kRepeat);
  EXPECT_NEAR(texture.sample({0.1f, 0.9f}, 1).x(), 0.5, 0.005);
  EXPECT_NEAR(texture.sample({0.1f, 0.9f}, 99).x(), 0.5, 0.005);
  EXPECT_NEAR(texture.sample({0.25f, 0.25f}, 0.5).x(), 0.25, 0.005);
  EXPECT_NEAR(texture.sample({0.25f, 0.25f}, -3).x(), 0, 1e-9);
}

TEST(Texture, AlphaIsMixedBetweenPixels) {
  const Texture texture({2, 1, {0, 0, 0, 0, 0, 0}}, TextureWrap::kClamp, TextureWrap::kClamp, {0, 255});
  EXPECT_EQ(texture.alphaAt({0.25f, 0.5f}), 0);
  EXPECT_EQ(texture.alphaAt({0.75f, 0.5f}), 1);
  EXPECT_NEAR(texture.alphaAt({0.5f, 0.5f}), 0.5, 1e-6);
  const Texture opaque({1, 1, {1, 2, 3}}, TextureWrap::kClamp, TextureWrap::kClamp);
  EXPECT_EQ(opaque.alphaAt({0.3f, 0.3f}), 1);
  EXPECT_THROW(Texture({1, 1, {1, 2, 3}}, TextureWrap::kClamp, TextureWrap::kClamp, {1, 2}), Error);
}

TEST(Texture, AnyShapeAndAnyCoordinateHasAColor) {
  const Texture texture(grey(5, 3, std::vector<int>(15, 188)), TextureWrap::kRepeat, TextureWrap::kMirror);
  for (const float u : {0.0f, 1.0f, -1e30f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
    for (const double level : {0.0, 0.7, 1.0, 2.0}) {
      EXPECT_NEAR(texture.sample({u, -u}, level).x(), linear(188), 0.005);
    }
  }
  EXPECT_THROW(Texture({2, 2, {}}, TextureWrap::kClamp, TextureWrap::kClamp), Error);
}

}  // namespace
}  // namespace limber
