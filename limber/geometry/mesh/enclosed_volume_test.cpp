#include "limber/geometry/mesh/enclosed_volume.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

TEST(EnclosedVolume, OfATetrahedronIsASixthWhereverItLies) {
  const std::vector<Triangle> outwards = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const Vec3f& at : {Vec3f(0, 0, 0), Vec3f(3, -2, 5)}) {
    const std::vector<Vec3f> corners = {at, at + Vec3f::UnitX(), at + Vec3f::UnitY(), at + Vec3f::UnitZ()};
    EXPECT_NEAR(enclosedVolume(corners, outwards), 1.0 / 6, 1e-6);
  }
}

TEST(EnclosedVolume, ComesNearToTheBallsAndTurnsItsSignWithTheFaces) {
  TriMesh ball = testing::icosphere(4);
  EXPECT_NEAR(enclosedVolume(ball.positions, ball.triangles), 4 * kPi / 3, 0.02);
  for (Triangle& t : ball.triangles) std::swap(t[0], t[1]);
  EXPECT_NEAR(enclosedVolume(ball.positions, ball.triangles), -4 * kPi / 3, 0.02);
}

}  // namespace
}  // namespace limber
