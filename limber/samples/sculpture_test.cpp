#include "limber/samples/sculpture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace limber {
namespace {

std::vector<Vec3> scatteredPoints(int count, double reach) {
  std::mt19937 random(7);
  std::vector<Vec3> points(static_cast<std::size_t>(count));
  for (Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = reach * (2 * double(random()) / double(std::mt19937::max()) - 1);
  }
  return points;
}

// The nearest of many spheres along the axis.
double sphereSweep(const Solid& s, const Vec3& point) {
  double nearest = 1e30;
  for (int i = 0; i <= 4000; ++i) {
    const double t = i / 4000.0;
    nearest = std::min(nearest, (point - s.a - t * (s.b - s.a)).norm() - (s.ra + t * (s.rb - s.ra)));
  }
  return nearest;
}

// Of solids of all kinds, on both sides and in the middle, melted, carved and cut.
Sculpture someFigure() {
  Sculpture s;
  s.add(ellipsoid({0, 0.3, 0}, {0.2, 0.25, 0.3}), 0.05);
  s.add(ellipsoid({0.05, 0.45, 0.1}, {0.19, 0.04, 0.19}, {0.2, 0.1, 1}), 0.01);
  s.add(roundCone({0.1, 0.4, 0}, 0.08, {0.5, 0.5, 0.1}, 0.03), 0.04);
  s.add(plate({0.5, 0.5, 0.1}, 0.02, {0.8, 0.6, -0.2}, 0.01, {0.4, 0.4, -0.4}, 0.012), 0.02);
  s.carve(roundCone({0.02, 0.5, 0.2}, 0.03, {0.02, 0.2, 0.35}, 0.02), 0.01);
  s.add(ellipsoid({0, 0.62, 0}, {0.05, 0.05, 0.05}), 0.02);
  s.cutBelow(0.1, 0.02);
  return s;
}

TEST(Sculpture, IsTheSameToTheBitNearItsSurfaceOncePrepared) {
  const Sculpture plain = someFigure();
  Sculpture prepared = someFigure();
  prepared.prepare();
  int near = 0;
  for (const Vec3& p : scatteredPoints(100000, 1)) {
    const double distance = plain.distance(p);
    if (std::abs(distance) < 0.1) {
      ++near;
      EXPECT_EQ(distance, prepared.distance(p));
    } else {
      EXPECT_GT(prepared.distance(p) / distance, 0) << "the sign changed";
    }
  }
  EXPECT_GT(near, 1000) << "too few points are near the surface to tell";
  prepared.add(ellipsoid({0, 0.9, 0}, {0.1, 0.1, 0.1}), 0.02);
  EXPECT_LT(prepared.distance({0, 0.9, 0}), 0) << "what is added later is not there";
}

TEST(Solid, RoundConeIsTheHullOfItsSpheres) {
  for (const Solid& cone : {roundCone({0, 0, 0}, 0.3, {1, 0.5, 0.2}, 0.1), roundCone({-1, 0, 0}, 0.05, {0, 1, 0}, 0.4),
                            roundCone({0, 0, 0}, 0.2, {0, 0, 1}, 0.2)}) {
    for (const Vec3& p : scatteredPoints(200, 1.5)) EXPECT_NEAR(cone.distance(p), sphereSweep(cone, p), 1e-5);
  }
}

TEST(Solid, RoundConeThatOneSphereSwallowsIsThatSphere) {
  const Solid cone = roundCone({0, 0, 0}, 1, {0.3, 0, 0}, 0.2);
  for (const Vec3& p : scatteredPoints(50, 2)) EXPECT_DOUBLE_EQ(cone.distance(p), p.norm() - 1);
}

TEST(Solid, EllipsoidIsZeroOnItsSurfaceAndExactForASphere) {
  const Solid egg = ellipsoid({0.1, 0.2, 0.3}, {0.5, 0.3, 0.8}, {1, 1, 0});
  const Vec3 forward = Vec3(1, 1, 0).normalized();
  EXPECT_NEAR(egg.distance(Vec3(0.1, 0.2, 0.3) + 0.8 * forward), 0, 1e-12);
  EXPECT_LT(egg.distance({0.1, 0.2, 0.3}), 0);
  const Solid sphere = ellipsoid({0, 0, 0}, {0.4, 0.4, 0.4});
  for (const Vec3& p : scatteredPoints(50, 1)) EXPECT_NEAR(sphere.distance(p), p.norm() - 0.4, 1e-12);
}

TEST(Solid, PlateOfOneThicknessIsTheDistanceToItsTriangle) {
  const Solid slab = plate({0, 0, 0}, 0.05, {1, 0, 0.1}, 0.05, {-0.4, 0.9, 0}, 0.05);
  for (const Vec3& p : scatteredPoints(60, 1.5)) {
    double nearest = 1e30;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; i + j <= 200; ++j) {
        const double v = i / 200.0, w = j / 200.0;
        nearest = std::min(nearest, (p - ((1 - v - w) * slab.a + v * slab.b + w * slab.c)).norm());
      }
    }
    EXPECT_NEAR(slab.distance(p), nearest - 0.05, 4e-3);
  }
}

Sculpture someCreature() {
  Sculpture s;
  s.add(ellipsoid({0, 0.5, 0}, {0.3, 0.25, 0.4}), 0.05);
  s.add(roundCone({0.2, 0.4, 0.1}, 0.1, {0.5, 0.0, 0.3}, 0.05), 0.08);
  s.add(plate({0.1, 0.6, 0}, 0.03, {0.8, 0.9, 0}, 0.02, {0.4, 0.5, -0.5}, 0.02), 0.04);
  s.carve(ellipsoid({0, 0.8, 0.1}, {0.1, 0.1, 0.1}), 0.03);
  s.cutBelow(0.02, 0.02);
  return s;
}

TEST(Sculpture, IsTheSameLeftAndRight) {
  const Sculpture s = someCreature();
  for (const Vec3& p : scatteredPoints(300, 1)) {
    EXPECT_EQ(s.distance(p), s.distance({-p.x(), p.y(), p.z()}));
  }
}

TEST(Sculpture, BlendsOnlyNearTheSeamAndOnlyOutwards) {
  Sculpture s;
  s.add(ellipsoid({0, 0, 0}, {1, 1, 1}), 0.2);
  s.add(ellipsoid({0, 1.5, 0}, {1, 1, 1}), 0.2);
  EXPECT_NEAR(s.distance({0, -1, 0}), 0, 1e-12);                        // far from the seam
  EXPECT_LT(s.distance({std::sqrt(1 - 0.75 * 0.75), 0.75, 0}), -0.02);  // on it the gap is filled
  for (const Vec3& p : scatteredPoints(100, 2)) {
    const double least = std::min(p.norm() - 1, (p - Vec3(0, 1.5, 0)).norm() - 1);
    EXPECT_LE(s.distance(p), least + 1e-12);
    EXPECT_GE(s.distance(p), least - 0.2 / 6 - 1e-12);
  }
}

TEST(Sculpture, NothingIsBelowItsFloorAndTheBoundsHoldTheRest) {
  const Sculpture s = someCreature();
  const Box box = s.bounds();
  for (const Vec3& p : scatteredPoints(500, 1.4)) {
    if (p.y() < 0.02) {
      EXPECT_GT(s.distance(p), 0);
    }
    const bool inside = (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
    if (s.distance(p) < 0) {
      EXPECT_TRUE(inside);
    }
  }
}

TEST(Sculpture, SlopeAgreesWithGradient) {
  const Sculpture s = someCreature();
  for (const Vec3& p : scatteredPoints(50, 0.6)) {
    EXPECT_LT((s.slope(p, s.distance(p)) - s.gradient(p)).norm(), 0.05) << p.transpose();
  }
}

}  // namespace
}  // namespace limber
