#include "limber/preview/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"
#include "limber/preview/image/palette.h"
#include "limber/preview/shapes.h"

namespace limber {
namespace {

PreviewOptions smallPicture(PreviewShow show = PreviewShow::kModel) {
  PreviewOptions options;
  options.show = show;
  options.width = 96;
  options.height = 72;
  options.view = {0, 6};
  return options;
}

// A ball of radius 1 on the ground, with one joint in its left and one in its right half.
Scene ballScene() {
  ShapeMesh ball;
  addSphere(ball, {0, 1, 0}, 1, {0.5f, 0.5f, 0.5f});
  Scene scene;
  scene.positions = ball.positions;
  scene.triangles = ball.triangles;
  scene.joints = {{"left", {0.5, 1, 0}, std::nullopt, 0.4}, {"right", {-0.5, 1, 0}, Index{0}, 0.4}};
  scene.bones = {{0, {0.5, 1, 0}, {-0.5, 1, 0}, 0}};
  scene.weights.slots = 1;
  for (const Vec3f& p : scene.positions) {
    scene.weights.joints.push_back(p.x() > 0 ? 0 : 1);
    scene.weights.weights.push_back(1);
  }
  return scene;
}

struct Pixel {
  int red, green, blue;
  int level() const { return red + green + blue; }
};

Pixel pixelAt(const Image& image, double x, double y) {
  const std::size_t at = (std::size_t(y * image.height) * std::size_t(image.width) + std::size_t(x * image.width)) * 3;
  return {image.pixels[at], image.pixels[at + 1], image.pixels[at + 2]};
}

TEST(Render, ShowsTheModelInFrontOfABrightBackground) {
  const Image image = render(ballScene(), smallPicture());
  ASSERT_EQ(image.pixels.size(), std::size_t(96 * 72 * 3));
  for (const auto& [x, y] : {std::pair(0.02, 0.02), {0.98, 0.02}, {0.02, 0.5}})
    EXPECT_GT(pixelAt(image, x, y).level(), 3 * 215);
  EXPECT_LT(pixelAt(image, 0.5, 0.5).level(), 3 * 205);
  EXPECT_GT(pixelAt(image, 0.42, 0.35).level(), pixelAt(image, 0.5, 0.85).level());  // lit from above, dark below
}

TEST(Render, ColoursAreThoseOfTheScene) {
  Scene scene = ballScene();
  scene.colors.assign(scene.positions.size(), Vec3f(0.6f, 0.02f, 0.02f));
  const Pixel red = pixelAt(render(scene, smallPicture()), 0.5, 0.5);
  EXPECT_GT(red.red, 2 * red.green);
  EXPECT_GT(red.red, 2 * red.blue);
}

TEST(Render, IsTheSameWithAnyNumberOfThreads) {
  for (const PreviewShow show :
       {PreviewShow::kModel, PreviewShow::kHandles, PreviewShow::kWeights, PreviewShow::kBones}) {
    setThreadCount(1);
    const Image one = render(ballScene(), smallPicture(show));
    setThreadCount(4);
    const Image four = render(ballScene(), smallPicture(show));
    setThreadCount(0);
    EXPECT_TRUE(one.pixels == four.pixels);
  }
}

TEST(Render, WeightsHaveTheColoursOfTheirJoints) {
  const Image image = render(ballScene(), smallPicture(PreviewShow::kWeights));
  // Seen from the front, the model's left (+X) is on the right of the picture.
  const auto channel = [](const Vec3f& color) {
    return std::max_element(color.data(), color.data() + 3) - color.data();
  };
  const auto brightest = [](const Pixel& p) {
    const std::array<int, 3> all = {p.red, p.green, p.blue};
    return std::max_element(all.begin(), all.end()) - all.begin();
  };
  EXPECT_EQ(brightest(pixelAt(image, 0.62, 0.62)), channel(jointColor(0)));
  EXPECT_EQ(brightest(pixelAt(image, 0.38, 0.62)), channel(jointColor(1)));
}

TEST(Render, TheHeatOfOneJointIsRedWhereItRulesAndBlueWhereNot) {
  PreviewOptions options = smallPicture(PreviewShow::kWeights);
  options.joint = "left";
  const Image image = render(ballScene(), options);
  const Pixel hot = pixelAt(image, 0.62, 0.62), cold = pixelAt(image, 0.38, 0.62);
  EXPECT_GT(hot.red, 2 * hot.blue);
  EXPECT_GT(cold.blue, cold.red);
}

TEST(Render, WhatIsTwiceAsLargeIsRedAndWhatIsNotStretchedBlue) {
  Scene scene = ballScene();
  scene.boundPositions = scene.positions;
  const Pixel still = pixelAt(render(scene, smallPicture(PreviewShow::kStretch)), 0.62, 0.62);
  EXPECT_GT(still.blue, still.red);
  for (Vec3f& p : scene.boundPositions) p *= 0.5f;
  const Pixel twice = pixelAt(render(scene, smallPicture(PreviewShow::kStretch)), 0.62, 0.62);
  EXPECT_GT(twice.red, 2 * twice.blue);
  scene.boundPositions.clear();
  EXPECT_THROW(render(scene, smallPicture(PreviewShow::kStretch)), Error);
}

TEST(Render, HandlesAreRedAndTheirRootIsNot) {
  const Image image = render(ballScene(), smallPicture(PreviewShow::kHandles));
  const Pixel root = pixelAt(image, 0.655, 0.5), handle = pixelAt(image, 0.33, 0.5);
  EXPECT_GT(handle.red, handle.green + 60);
  EXPECT_GT(root.green, handle.green + 40);
}

TEST(Render, TheGroundBelowTheModelIsInItsShadow) {
  PreviewOptions options = smallPicture();
  options.view = {0, 30};
  const Image image = render(ballScene(), options);
  // The key light comes from the upper left, so the shadow falls to the right.
  EXPECT_LT(pixelAt(image, 0.78, 0.62).level(), pixelAt(image, 0.08, 0.62).level() - 12);
}

TEST(Render, AFixedFrameKeepsTheCameraStill) {
  Scene scene = ballScene();
  PreviewOptions options = smallPicture();
  options.frame = Box{};
  options.frame->add({-4, 0, -4});
  options.frame->add({4, 8, 4});
  const Image wide = render(scene, options);
  EXPECT_LT(pixelAt(wide, 0.5, 0.73).level(), 3 * 210);  // the ball is small and low in the picture now
  EXPECT_GT(pixelAt(wide, 0.5, 0.385).level(), 3 * 215);
  for (Vec3f& p : scene.positions) p.y() += 4;
  const Image jump = render(scene, options);
  EXPECT_LT(pixelAt(jump, 0.5, 0.385).level(), 3 * 210);
  EXPECT_GT(pixelAt(jump, 0.5, 0.73).level(), 3 * 210);
}

TEST(Render, TheBackdropIsWhatThePictureShowsBesideTheModel) {
  const PreviewOptions options = smallPicture();
  const Image image = render(ballScene(), options), backdrop = renderBackdrop(options);
  ASSERT_EQ(backdrop.pixels.size(), image.pixels.size());
  const std::ptrdiff_t rows = 3 * 96 * 5;  // above the ball and its shadow
  EXPECT_TRUE(std::equal(image.pixels.begin(), image.pixels.begin() + rows, backdrop.pixels.begin()));
  EXPECT_NE(image.pixels, backdrop.pixels);
}

TEST(Render, ATransparentPictureLaidOnAColourIsThePictureOnThatColour) {
  PreviewOptions options = smallPicture();
  options.backdrop = parseBackdrop("transparent");
  const Image clear = render(ballScene(), options);
  options.backdrop = parseBackdrop("#3366cc");
  const Image blue = render(ballScene(), options);
  ASSERT_EQ(clear.channels, 4u);
  ASSERT_EQ(clear.pixels.size(), std::size_t(96 * 72 * 4));
  ASSERT_EQ(blue.pixels.size(), std::size_t(96 * 72 * 3));
  const std::array<int, 3> backdrop = {0x33, 0x66, 0xcc};
  std::size_t empty = 0, covered = 0, shadow = 0;
  for (std::size_t i = 0; i < std::size_t(96 * 72); ++i) {
    const std::uint8_t alpha = clear.pixels[4 * i + 3];
    const bool isBlack = clear.pixels[4 * i] + clear.pixels[4 * i + 1] + clear.pixels[4 * i + 2] == 0;
    empty += alpha == 0;
    covered += alpha == 255;
    shadow += alpha > 0 && alpha < 255 && isBlack;
    for (std::size_t c = 0; c < 3; ++c) {
      const int expected = alpha == 0 ? backdrop[c] : clear.pixels[4 * i + c];
      if (alpha == 0 || alpha == 255) {
        EXPECT_EQ(blue.pixels[3 * i + c], expected);
      }
      // A shadow is as dark on white whoever mixes; on other colours nearly.
      if (alpha > 0 && alpha < 255 && isBlack) {
        EXPECT_NEAR(blue.pixels[3 * i + c], backdrop[c] * (255 - alpha) / 255.0, 12);
      }
    }
  }
  EXPECT_GT(empty, 1000u);
  EXPECT_GT(covered, 500u);
  EXPECT_GT(shadow, 50u);
  EXPECT_THROW(parseBackdrop("blue"), Error);
  EXPECT_THROW(parseBackdrop("#33"), Error);
  EXPECT_THROW(parseBackdrop("#33gg66"), Error);
}

TEST(Render, TheCameraGoesRoundTheMiddleWithItsLight) {
  PreviewOptions options = smallPicture(PreviewShow::kHandles);
  options.frame = Box();
  options.frame->add({-2, 0, -2});
  options.frame->add({2, 2, 2});
  options.view.azimuth = 70;
  const Image there = render(ballScene(), options);
  options.view.azimuth = -20;
  EXPECT_NE(render(ballScene(), options).pixels, there.pixels);
  options.turn = 90;
  const Image turned = render(ballScene(), options);
  std::size_t other = 0;  // pixels at edges, by rounding
  for (std::size_t i = 0; i < there.pixels.size(); ++i) other += std::abs(there.pixels[i] - turned.pixels[i]) > 2;
  EXPECT_LT(other, there.pixels.size() / 200);
}

TEST(Render, SaysWhatIsMissing) {
  Scene bare = ballScene();
  bare.joints.clear();
  bare.weights = {};
  EXPECT_NO_THROW(render(bare, smallPicture()));
  for (const PreviewShow show : {PreviewShow::kHandles, PreviewShow::kWeights, PreviewShow::kBones}) {
    EXPECT_THROW(render(bare, smallPicture(show)), Error);
  }
  PreviewOptions unknown = smallPicture(PreviewShow::kWeights);
  unknown.joint = "tail";
  EXPECT_THROW(render(ballScene(), unknown), Error);
  PreviewOptions huge = smallPicture();
  huge.width = 100000;
  EXPECT_THROW(render(ballScene(), huge), Error);
  EXPECT_THROW(render(Scene{}, smallPicture()), Error);
  EXPECT_THROW(parsePreviewShow("ghosts"), Error);
}

TEST(Palette, NeighbouringJointsAreToldApart) {
  for (Index j = 0; j < 60; ++j) {
    for (Index other = j + 1; other < j + 5; ++other)
      EXPECT_GT((jointColor(j) - jointColor(other)).norm(), 0.15f) << j << ' ' << other;
  }
}

TEST(Palette, SrgbSurvivesTheWayThereAndBack) {
  for (int level = 0; level < 256; ++level) EXPECT_EQ(srgbByte(linearFromSrgb(level, 0, 0).x()), level);
}

TEST(Shapes, ASphereIsClosedAndWoundOutwards) {
  ShapeMesh ball;
  addSphere(ball, {1, 2, 3}, 0.5, {1, 0, 0});
  double volume = 0;
  for (const Triangle& t : ball.triangles) {
    const auto at = [&](std::size_t c) { return Vec3(ball.positions[t[c]].cast<double>() - Vec3(1, 2, 3)); };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
  }
  EXPECT_NEAR(std::abs(volume), 4.0 / 3 * kPi * 0.125, 0.02);
}

}  // namespace
}  // namespace limber
