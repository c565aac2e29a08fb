#include "limber/actions/transfer/texture_bake.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/core/random.h"
#include "limber/document/images.h"
#include "limber/document/testing/scene_builder.h"

namespace limber {
namespace {

const std::vector<Vec2f> kSquare = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
const std::vector<Triangle> kHalves = {{0, 2, 1}, {1, 2, 3}};

Eigen::Vector2d uvOf(const Texel& texel, std::span<const Triangle> triangles, std::span<const Vec2f> uvs) {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    uv += texel.weights[static_cast<Eigen::Index>(k)] * uvs[triangles[texel.triangle][k]].cast<double>();
  }
  return uv;
}

TEST(TextureBake, EachPixelOfASquareShowsItsMiddle) {
  for (const int size : {1, 4, 7, 64}) {
    const auto texels = texelsOf(kHalves, kSquare, size);
    ASSERT_TRUE(texels) << "pixels on the shared diagonal belong to one of both";
    ASSERT_EQ(texels->size(), static_cast<std::size_t>(size * size));
    for (std::size_t i = 0; i < texels->size(); ++i) {
      EXPECT_EQ((*texels)[i].pixel, i);
      const Eigen::Vector2d middle((static_cast<double>(i % size) + 0.5) / size,
                                   (static_cast<double>(i / size) + 0.5) / size);
      EXPECT_LT((uvOf((*texels)[i], kHalves, kSquare) - middle).norm(), 1e-6);
      EXPECT_NEAR((*texels)[i].weights.sum(), 1, 1e-9);
    }
  }
}

// Against every pixel's middle and every triangle.
TEST(TextureBake, TexelsAreThePixelsWhoseMiddleIsInATriangle) {
  constexpr int kSize = 48;
  Random random(5);
  const auto number = [&] { return static_cast<float>(random.below(10000)) / 10000.0f; };
  for (int round = 0; round < 40; ++round) {
    const std::vector<Vec2f> uvs = {{number(), number()}, {number(), number()}, {number(), number()}};
    const std::vector<Triangle> triangles = {{0, 1, 2}};
    const auto texels = texelsOf(triangles, uvs, kSize);
    ASSERT_TRUE(texels);
    std::vector<bool> isTexel(kSize * kSize, false);
    for (const Texel& texel : *texels) isTexel[texel.pixel] = true;
    const Eigen::Vector2d a = uvs[0].cast<double>(), b = uvs[1].cast<double>(), c = uvs[2].cast<double>();
    const auto side = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    for (std::size_t pixel = 0; pixel < isTexel.size(); ++pixel) {
      const Eigen::Vector2d p((static_cast<double>(pixel % kSize) + 0.5) / kSize,
                              (static_cast<double>(pixel / kSize) + 0.5) / kSize);
      const double x = side(a, b, p), y = side(b, c, p), z = side(c, a, p);
      if (std::min({std::abs(x), std::abs(y), std::abs(z)}) < 1e-7) continue;  // on an edge
      EXPECT_EQ(isTexel[pixel], (x > 0) == (y > 0) && (y > 0) == (z > 0)) << round << " " << pixel;
    }
  }
}

TEST(TextureBake, WhatLiesOnOtherTrianglesOrBeyondThePictureFitsNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(texelsOf(std::vector<Triangle>{{0, 2, 1}, {0, 2, 3}}, kSquare, 8)) << "they overlap";
  EXPECT_FALSE(texelsOf(std::vector<Triangle>{{0, 2, 1}, {1, 2, 0}}, kSquare, 8)) << "mirrored onto each other";
  EXPECT_FALSE(texelsOf(kHalves, std::vector<Vec2f>{{0, 0}, {1.1f, 0}, {0, 1}, {1, 1}}, 8));
  EXPECT_FALSE(texelsOf(kHalves, std::vector<Vec2f>{{0, 0}, {1, -0.1f}, {0, 1}, {1, 1}}, 8));
  EXPECT_FALSE(texelsOf(kHalves, std::vector<Vec2f>{{0, 0}, {nan, 0}, {0, 1}, {1, 1}}, 8));
  const auto line = texelsOf(std::vector<Triangle>{{0, 0, 1}, {0, 2, 1}}, kSquare, 8);
  ASSERT_TRUE(line) << "a triangle without area covers nothing";
  EXPECT_EQ((*line)[0].triangle, 1u);
}

TEST(TextureBake, TheGutterIsFilledFromWhatIsBesideIt) {
  constexpr int kSize = 32;
  const std::vector<Texel> texels = {{0, 0, Vec3::Zero()}, {1, 0, Vec3::Zero()}};
  const std::vector<Vec3f> colors = {{1, 0, 0}, {1, 0, 0}};
  const std::vector<Vec3f> picture = pictureOf(texels, colors, kSize);
  ASSERT_EQ(picture.size(), std::size_t{kSize * kSize});
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const bool isNear = y <= 8 && x <= 1 + 8;
      EXPECT_LT((picture[static_cast<std::size_t>(kSize * y + x)] - Vec3f(isNear ? 1 : 0, 0, 0)).norm(), 1e-6)
          << x << " " << y;
    }
  }
}

TEST(TextureBake, APictureStandsInTheDocument) {
  testing::SceneBuilder scene;
  Asset& asset = scene.asset();
  asset.document.materials.emplace_back().name = "skin";
  const Bytes png = {0x89, 'P', 'N', 'G', 13, 10, 26, 10};
  setBaseColorPicture(asset, 0, png);
  checkAsset(asset);
  const gltf::Material& material = asset.document.materials[0];
  ASSERT_TRUE(material.pbrMetallicRoughness && material.pbrMetallicRoughness->baseColorTexture);
  ASSERT_EQ(material.pbrMetallicRoughness->baseColorTexture->index, 0u);
  EXPECT_EQ(imageBytes(asset, asset.document.textures[0].source.value()), png);
}

}  // namespace
}  // namespace limber
