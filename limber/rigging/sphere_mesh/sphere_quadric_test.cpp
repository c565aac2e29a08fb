#include "limber/rigging/sphere_mesh/sphere_quadric.h"

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

using testing::TestRandom;

struct Plane {
  Vec3 point, normal;
  double weight;
};

std::vector<Plane> randomPlanes(int count, std::uint64_t seed) {
  TestRandom random(seed);
  const auto vector = [&] { return Vec3(2 * random.unit() - 1, 2 * random.unit() - 1, 2 * random.unit() - 1); };
  std::vector<Plane> planes;
  for (int i = 0; i < count; ++i) planes.push_back({vector(), vector().normalized(), 0.1 + random.unit()});
  return planes;
}

SphereQuadric quadricOf(const std::vector<Plane>& planes) {
  SphereQuadric quadric;
  for (const Plane& plane : planes) quadric.addPlane(plane.point, plane.normal, plane.weight);
  return quadric;
}

double errorByHand(const std::vector<Plane>& planes, const Sphere& sphere) {
  double error = 0;
  for (const auto& [point, normal, weight] : planes) {
    const double distance = normal.dot(point - sphere.center) - sphere.radius;
    error += weight * (distance * distance + SphereQuadric::kCentering * (point - sphere.center).squaredNorm());
  }
  return error;
}

TEST(SphereQuadric, IsTheWeightedSumOfSquaredDistances) {
  const std::vector<Plane> planes = randomPlanes(7, 1);
  const SphereQuadric quadric = quadricOf(planes);
  for (const Sphere& sphere : {Sphere{{0, 0, 0}, 0}, Sphere{{0.3, -0.2, 0.9}, 0.7}, Sphere{{-5, 2, 1}, 3}}) {
    EXPECT_NEAR(quadric.error(sphere), errorByHand(planes, sphere), 1e-12);
  }
}

TEST(SphereQuadric, NoSphereWithARadiusIsBetterThanTheMinimum) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const std::vector<Plane> planes = randomPlanes(1 + static_cast<int>(seed % 9), seed);
    const SphereQuadric quadric = quadricOf(planes);
    const Sphere best = quadric.minimum();
    ASSERT_GE(best.radius, 0);
    EXPECT_NEAR(quadric.error(best), quadric.minimumError(), 1e-9);
    for (int i = 0; i < 4; ++i) {
      for (const double step : {-1e-3, 1e-3}) {
        Sphere other = best;
        if (i < 3) {
          other.center[i] += step;
        } else {
          other.radius = std::max(0.0, other.radius + step);
        }
        EXPECT_GE(errorByHand(planes, other), errorByHand(planes, best) - 1e-12) << seed << " " << i;
      }
    }
  }
}

TEST(SphereQuadric, FindsTheSphereInsideABall) {
  SphereQuadric quadric;
  const Vec3 center(0.2, 0.1, -0.3);
  for (const Vec3f& p : testing::ball(2).positions) {
    const Vec3 normal = p.cast<double>().normalized();
    quadric.addPlane(center + 0.5 * normal, normal, 1);
  }
  const Sphere sphere = quadric.minimum();
  EXPECT_LT((sphere.center - center).norm(), 1e-9);
  EXPECT_NEAR(sphere.radius, 0.5, 1e-9);
}

TEST(SphereQuadric, TurnedInsideOutTheRadiusIsZeroNotNegative) {
  SphereQuadric quadric;
  for (const Vec3f& p : testing::ball(1).positions) quadric.addPlane(p.cast<double>(), -p.cast<double>(), 1);
  EXPECT_EQ(quadric.minimum().radius, 0);
}

TEST(SphereQuadric, OnAFlatPartTheSphereIsAPointInItsMiddle) {
  SphereQuadric quadric;
  for (const Vec3f& p : testing::flatGrid(4, 2).positions) quadric.addPlane(p.cast<double>(), Vec3::UnitZ(), 1);
  const Sphere sphere = quadric.minimum();
  EXPECT_LT((sphere.center - Vec3(2, 1, 0)).norm(), 1e-9);
  EXPECT_LT(sphere.radius, 1e-9);
}

TEST(SphereQuadric, TheRadiusNeverExceedsTheRootMeanSquareDistance) {
  for (std::uint64_t seed = 1; seed < 60; ++seed) {
    const std::vector<Plane> planes = randomPlanes(3, seed);
    const Sphere sphere = quadricOf(planes).minimum();
    double square = 0, weight = 0;
    for (const Plane& plane : planes) {
      square += plane.weight * (plane.point - sphere.center).squaredNorm();
      weight += plane.weight;
    }
    EXPECT_LE(sphere.radius, std::sqrt(square / weight) + 1e-12);
  }
}

TEST(SphereQuadric, SumsCostAtLeastAsMuchAsTheirParts) {
  for (std::uint64_t seed = 1; seed < 60; ++seed) {
    const SphereQuadric a = quadricOf(randomPlanes(3, seed)), b = quadricOf(randomPlanes(4, seed + 1000));
    SphereQuadric sum = a;
    sum += b;
    EXPECT_GE(sum.minimumError(), std::max(a.minimumError(), b.minimumError()) - 1e-12);
  }
}

TEST(SphereQuadric, MirrorsWithTheSurface) {
  std::vector<Plane> planes = randomPlanes(5, 4);
  const SphereQuadric quadric = quadricOf(planes);
  for (Plane& plane : planes) {
    plane.point.x() *= -1;
    plane.normal.x() *= -1;
  }
  const SphereQuadric mirrored = quadricOf(planes), both = quadric.withMirrorImage();
  for (int i = 0; i < SphereQuadric::kTerms; ++i) {
    EXPECT_NEAR(quadric.mirrored().terms[i], mirrored.terms[i], 1e-14);
    EXPECT_NEAR(both.terms[i], quadric.terms[i] + mirrored.terms[i], 1e-14);
  }
  EXPECT_EQ(both.minimum().center.x(), 0);
}

}  // namespace

}  // namespace limber
