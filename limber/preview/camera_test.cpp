#include "limber/preview/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(ParseView, KnowsNamesAndAngles) {
  EXPECT_EQ(parseView("side").azimuth, 90);
  EXPECT_EQ(parseView("top").elevation, 90);
  const ViewDirection view = parseView("-30.5,12");
  EXPECT_EQ(view.azimuth, -30.5);
  EXPECT_EQ(view.elevation, 12);
}

TEST(ParseView, RefusesTheRest) {
  for (const char* text : {"", "left", "30", "30,", ",5", "a,b", "30,91", "nan,0", "1,2,3"}) {
    EXPECT_THROW(parseView(text), Error) << text;
  }
}

std::vector<Vec3f> cloud(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::vector<Vec3f> points(40);
  for (Vec3f& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = float(random() % 1000) * 0.01f * float(axis + 1) - 3;
  }
  return points;
}

TEST(FrameCamera, HoldsAllPointsTightly) {
  for (const ViewDirection& view : {ViewDirection{0, 0}, {35, 14}, {200, -40}, {0, 90}}) {
    const std::vector<Vec3f> points = cloud(3);
    const Camera camera = frameCamera(points, view, 300, 200);
    double widest = 0;
    for (const Vec3f& p : points) {
      const Vec3 seen = camera.project(p.cast<double>());
      EXPECT_GT(seen.z(), 0);
      widest = std::max({widest, std::abs(seen.x() - 150) / 150, std::abs(seen.y() - 100) / 100});
    }
    EXPECT_NEAR(widest, 0.84, 1e-9);  // the margin is met exactly by the extreme points
  }
}

TEST(FrameCamera, LooksFromTheSideThatTheNameSays) {
  const std::vector<Vec3f> points = {{-1, -1, -1}, {1, 1, 1}};
  EXPECT_GT(frameCamera(points, parseView("front"), 100, 100).eye.z(), 1);
  EXPECT_GT(frameCamera(points, parseView("side"), 100, 100).eye.x(), 1);
  EXPECT_LT(frameCamera(points, parseView("back"), 100, 100).eye.z(), -1);
  EXPECT_GT(frameCamera(points, parseView("top"), 100, 100).eye.y(), 1);
}

TEST(Camera, RayIsTheInverseOfProjection) {
  const Camera camera = frameCamera(cloud(5), {35, 14}, 320, 240);
  for (const Vec3f& p : cloud(6)) {
    const Vec3 seen = camera.project(p.cast<double>());
    EXPECT_LT((camera.eye + seen.z() * camera.ray(seen.x(), seen.y()) - p.cast<double>()).norm(), 1e-9);
  }
}

TEST(FrameCamera, ASinglePointHasAPictureToo) {
  const std::vector<Vec3f> point = {{1, 2, 3}};
  const Camera camera = frameCamera(point, {}, 64, 64);
  const Vec3 seen = camera.project({1, 2, 3});
  EXPECT_NEAR(seen.x(), 32, 1e-9);
  EXPECT_GT(seen.z(), 0);
}

}  // namespace
}  // namespace limber
