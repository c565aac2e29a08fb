#include "limber/evaluate/motion/body_inside.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using limber::testing::icosphere;
using limber::testing::join;
using limber::testing::moved;

TEST(BodyInside, ABallEndsAtItsSurface) {
  const BodyInside ball(icosphere(4));
  EXPECT_TRUE(ball.contains({0.1, 0.2, 0.3}));
  EXPECT_FALSE(ball.contains({1.1, 0, 0}));
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 0, -1), Vec3(Vec3(1, 2, 3).normalized())}) {
    EXPECT_NEAR(ball.exitFrom(Vec3::Zero(), direction).value(), 1, 0.01);
    EXPECT_NEAR(ball.exitFrom(0.5 * direction, direction).value(), 0.5, 0.01);
  }
}

// Balls of radius 1 about 0 and 1.5 overlap; one of radius 0.3 is within the first.
TEST(BodyInside, SurfacesWithinDoNotEndIt) {
  const TriMesh ball = icosphere(4);
  const TriMesh both = join(ball, moved(ball, Vec3f::Ones(), {1.5f, 0, 0}));
  const BodyInside body(join(both, moved(ball, Vec3f::Constant(0.3f), Vec3f::Zero())));
  EXPECT_NEAR(body.exitFrom(Vec3::Zero(), Vec3::UnitX()).value(), 2.5, 0.01);
  EXPECT_NEAR(body.exitFrom(Vec3::Zero(), -Vec3::UnitX()).value(), 1, 0.01);
  EXPECT_NEAR(body.exitFrom(Vec3::Zero(), Vec3::UnitY()).value(), 1, 0.01);
}

TEST(BodyInside, AlongAnOpenTubeThereIsNoEnd) {
  const BodyInside tube(limber::testing::tube(24, 9, false));
  EXPECT_FALSE(tube.exitFrom(Vec3::Zero(), Vec3::UnitX()));
  EXPECT_NEAR(tube.exitFrom(Vec3::Zero(), Vec3::UnitY()).value(), 0.1, 1e-3);
}

}  // namespace
}  // namespace limber
