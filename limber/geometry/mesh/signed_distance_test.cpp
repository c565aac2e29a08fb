#include "limber/geometry/mesh/signed_distance.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

SignedDistance distancesOf(const TriMesh& mesh, Index resolution) {
  return {mesh, Bvh(mesh), WindingNumber(mesh), resolution};
}

}  // namespace

TEST(SignedDistance, OfASphere) {
  const TriMesh mesh = testing::moved(testing::icosphere(4), Vec3f::Constant(0.5f), {0.1f, 0.2f, 0.3f});
  const SignedDistance distance = distancesOf(mesh, 40);
  const Vec3 center(0.1, 0.2, 0.3);
  for (std::size_t node = 0; node < distance.nodeCount(); ++node) {
    const double exact = (distance.position(node) - center).norm() - 0.5;
    // Cells that the surface does not reach are filled linearly.
    EXPECT_NEAR(distance.value(node), exact, std::abs(exact) < 0.05 ? 0.005 : 0.06);
  }
  const Vec3 out = Vec3(1, 2, 2) / 3;
  EXPECT_NEAR(distance.at(center + 0.45 * out), -0.05, 0.006);
  EXPECT_NEAR(distance.at(center + 10 * out), 9.5, 0.5);
}

TEST(SignedDistance, IsTheTreesAnswerNearTheSurface) {
  for (const testing::NamedMesh& named : testing::catalogue()) {
    if (named.mesh.triangles.empty()) continue;
    SCOPED_TRACE(named.name);
    const Bvh surface(named.mesh);
    const WindingNumber winding(named.mesh);
    const SignedDistance distance(named.mesh, surface, winding, 16);
    for (std::size_t node = 0; node < distance.nodeCount(); ++node) {
      const Vec3 point = distance.position(node);
      const double exact = surface.nearestPoint(point).distance;
      if (exact > distance.spacing() || exact == 0) continue;
      EXPECT_FLOAT_EQ(std::abs(distance.value(node)), static_cast<float>(exact));
      const double turns = winding.at(point);
      if (std::abs(turns - 0.5) > 0.1) {
        EXPECT_EQ(distance.value(node) < 0, turns > 0.5);
      }
    }
  }
}

TEST(SignedDistance, IsTheSameOnOneThread) {
  const TriMesh mesh = testing::icosphere(3);
  const SignedDistance many = distancesOf(mesh, 24);
  setThreadCount(1);
  const SignedDistance one = distancesOf(mesh, 24);
  setThreadCount(0);
  ASSERT_EQ(many.nodeCount(), one.nodeCount());
  for (std::size_t node = 0; node < many.nodeCount(); ++node) EXPECT_EQ(many.value(node), one.value(node));
}

TEST(SignedDistance, RefusesWhatHasNone) {
  EXPECT_THROW(distancesOf(TriMesh(), 16), Error);
  EXPECT_THROW(distancesOf(testing::icosphere(1), 4), Error);
  EXPECT_THROW(distancesOf(testing::icosphere(1), 4000), Error);
}

}  // namespace limber
