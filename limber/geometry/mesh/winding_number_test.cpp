#include "limber/geometry/mesh/winding_number.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {

namespace {

std::vector<Vec3> pointsAround(int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.5, 1.5);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

}  // namespace

TEST(WindingNumber, IsTheSumOfSolidAngles) {
  for (const testing::NamedMesh& named : testing::catalogue()) {
    SCOPED_TRACE(named.name);
    const WindingNumber winding(named.mesh);
    for (const Vec3& point : pointsAround(200)) EXPECT_NEAR(winding.at(point), winding.exactAt(point), 0.02);
  }
}

TEST(WindingNumber, ComesNearerWithMoreAccuracy) {
  const TriMesh mesh = testing::icosphere(4);
  const WindingNumber rough(mesh, {}, 1.5), fine(mesh, {}, 4);
  double roughError = 0, fineError = 0;
  for (const Vec3& point : pointsAround(400)) {
    roughError = std::max(roughError, std::abs(rough.at(point) - rough.exactAt(point)));
    fineError = std::max(fineError, std::abs(fine.at(point) - fine.exactAt(point)));
  }
  EXPECT_LT(fineError, 1e-3);
  EXPECT_LT(fineError, roughError);
}

TEST(WindingNumber, IsOneInsideAndZeroOutside) {
  const TriMesh mesh = testing::icosphere(4);
  const WindingNumber winding(mesh);
  for (const Vec3& point : pointsAround(400)) {
    if (std::abs(point.norm() - 1) < 0.01) continue;
    EXPECT_NEAR(winding.at(point), point.norm() < 1 ? 1 : 0, 0.02);
  }
}

TEST(WindingNumber, CountsEachLayer) {
  const TriMesh inner = testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero());
  const WindingNumber winding(testing::join(testing::icosphere(3), inner));
  EXPECT_NEAR(winding.at({0.1, 0, 0}), 2, 0.02);
  EXPECT_NEAR(winding.at({0.7, 0, 0}), 1, 0.02);
}

TEST(WindingNumber, OfAnOpenSurfaceLiesBetween) {
  TriMesh half = testing::icosphere(4);
  std::erase_if(half.triangles, [&](const Triangle& t) {
    return half.positions[t[0]].y() + half.positions[t[1]].y() + half.positions[t[2]].y() > 0;
  });
  const WindingNumber winding(half);
  EXPECT_NEAR(winding.at(Vec3::Zero()), 0.5, 0.03);
  EXPECT_GT(winding.at({0, -0.8, 0}), 0.8);
  EXPECT_LT(winding.at({0, 0.8, 0}), 0.3);
}

TEST(WindingNumber, TurnsTrianglesThatAreFlipped) {
  const TriMesh mesh = testing::icosphere(2);
  const WindingNumber winding(mesh, std::vector<bool>(mesh.triangles.size(), true));
  EXPECT_NEAR(winding.at({0.1, 0.2, 0.1}), -1, 0.02);
  EXPECT_THROW(WindingNumber(mesh, {true}), Error);
}

TEST(WindingNumber, TakesAnyMesh) {
  EXPECT_EQ(WindingNumber(TriMesh()).at(Vec3::Zero()), 0);
  TriMesh point;  // many triangles without area at one position
  point.positions = {{0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}};
  point.triangles.assign(100, {0, 1, 2});
  const WindingNumber winding(point);
  EXPECT_EQ(winding.at(Vec3::Zero()), 0);
  EXPECT_TRUE(std::isfinite(winding.at({0.5, 0.5, 0.5})));
}

}  // namespace limber
