// Maps whose singular values are known, and surfaces stretched by known amounts.
#include "limber/evaluate/skin/surface_stretch.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using limber::testing::catalogue;
using limber::testing::flatGrid;
using limber::testing::MeshName;
using limber::testing::NamedMesh;

std::array<Vec3, 3> mapped(const std::array<Vec3, 3>& corners, const Mat3& map) {
  return {map * corners[0], map * corners[1], map * corners[2]};
}

Mat3 turned(double degrees, const Vec3& axis) {
  return Eigen::AngleAxisd(degrees * kDegree, axis.normalized()).toRotationMatrix();
}

TEST(TriangleStretch, OfAScaledAndTurnedTriangleIsTheScale) {
  // In the plane z = 0 scaled by a and b along turned axes, then turned in space.
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) corner = {random.uniform(-1, 1), random.uniform(-1, 1), 0};
    if (triangleArea(corners[0], corners[1], corners[2]) < 0.01) continue;
    const double a = random.uniform(0.1, 3), b = random.uniform(0.1, 3);
    const Mat3 scale = Vec3(a, b, 1).asDiagonal(), axes = turned(360 * random.uniform(0, 1), Vec3::UnitZ());
    const Mat3 map = turned(77, {1, 2, 3}) * axes * scale * axes.transpose();
    const auto stretch = triangleStretch(corners, mapped(corners, map));
    ASSERT_TRUE(stretch);
    EXPECT_NEAR(stretch->most, std::max(a, b), 1e-9);
    EXPECT_NEAR(stretch->least, std::min(a, b), 1e-9);
    EXPECT_NEAR(stretch->distortion(), std::min(kMaxDistortion, std::max(std::max(a, b), 1 / std::min(a, b))), 1e-6);
  }
}

// A shear by s has the singular values (s +- sqrt(s^2 + 4)) / 2 without their signs: the silver ratio for s = 2.
TEST(TriangleStretch, OfAShearIsItsClosedForm) {
  Mat3 shear = Mat3::Identity();
  shear(0, 1) = 2;
  const std::array<Vec3, 3> corners = {Vec3(0, 0, 0), Vec3(1, 0.25, 0), Vec3(0.5, 2, 0)};
  const auto stretch = triangleStretch(corners, mapped(corners, shear));
  ASSERT_TRUE(stretch);
  EXPECT_NEAR(stretch->most, 1 + std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(stretch->least, std::sqrt(2.0) - 1, 1e-12);
}

TEST(TriangleStretch, SqueezedFlatIsTheMostDistortion) {
  const std::array<Vec3, 3> corners = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const auto line = triangleStretch(corners, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)});
  ASSERT_TRUE(line);
  EXPECT_EQ(line->least, 0);
  EXPECT_EQ(line->distortion(), kMaxDistortion);
  const auto point = triangleStretch(corners, {Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)});
  ASSERT_TRUE(point);
  EXPECT_EQ(point->most, 0);
  EXPECT_EQ(point->distortion(), kMaxDistortion);
  EXPECT_FALSE(triangleStretch({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, corners));
  EXPECT_FALSE(triangleStretch({Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, corners));
}

TEST(SurfaceStretch, IsTheMeanOverTheArea) {
  // The left quarter of a grid is made twice as long, the rest is moved along.
  const TriMesh rest = flatGrid(4, 3);
  TriMesh posed = rest;
  for (Vec3f& p : posed.positions) p.x() += std::min(p.x(), 0.25f);
  const SurfaceStretch stretch = surfaceStretch(rest.positions, posed.positions, rest.triangles);
  EXPECT_NEAR(stretch.mean, 0.25, 1e-6);
  EXPECT_NEAR(stretch.p95, 1, 1e-6);
  const SurfaceStretch back = surfaceStretch(posed.positions, rest.positions, rest.triangles);
  EXPECT_NEAR(back.mean, 2.0 / 5, 1e-6);  // halves count as doubles; twice the area of five parts
}

class SurfaceStretchOverTheCatalogue : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(SurfaceStretchOverTheCatalogue, TurningAndMirroringStretchNothingAndScalesStretchAlike) {
  const TriMesh& rest = GetParam().mesh;
  TriMesh posed = rest;
  for (Vec3f& p : posed.positions) p = (turned(50, {1, 1, 0}) * Vec3(-p.x(), p.y(), p.z())).cast<float>();
  const SurfaceStretch still = surfaceStretch(rest.positions, posed.positions, rest.triangles);
  // Slivers of a height near a float's precision are stretched by rounding.
  EXPECT_NEAR(still.mean, 0, 1e-4);
  EXPECT_NEAR(still.p95, 0, 1e-4);
  for (Vec3f& p : posed.positions) p *= 1.5f;
  EXPECT_NEAR(surfaceStretch(rest.positions, posed.positions, rest.triangles).mean, 0.5, 1e-4);
  EXPECT_EQ(triangleDistortions(rest.positions, posed.positions, rest.triangles).size(), rest.triangles.size());
}

INSTANTIATE_TEST_SUITE_P(Catalogue, SurfaceStretchOverTheCatalogue, ::testing::ValuesIn(catalogue()), MeshName());

std::vector<Vec2f> flatCoordinates(const TriMesh& mesh, float u = 1, float v = 1) {
  std::vector<Vec2f> uvs;
  for (const Vec3f& p : mesh.positions) uvs.emplace_back(u * p.x(), v * p.y());
  return uvs;
}

TEST(TextureStretch, IsOneWhereTexelsAreSquaresOfOneSize) {
  const TriMesh grid = flatGrid(5, 4, 0.3f);
  EXPECT_NEAR(*textureStretch(flatCoordinates(grid), grid.positions, grid.triangles), 1, 1e-6);
  EXPECT_NEAR(*textureStretch(flatCoordinates(grid, 7, 7), grid.positions, grid.triangles), 1, 1e-6);
  EXPECT_NEAR(*textureStretch(flatCoordinates(grid, -1, 1), grid.positions, grid.triangles), 1, 1e-6);
}

// Twice as long in one direction: the values 2 and 1 have the root mean square sqrt(5 / 2), the mean scale is sqrt(2).
TEST(TextureStretch, OfAStretchedSurfaceIsItsClosedForm) {
  const TriMesh grid = flatGrid(5, 4);
  TriMesh longer = grid;
  for (Vec3f& p : longer.positions) p.x() *= 2;
  EXPECT_NEAR(*textureStretch(flatCoordinates(grid), longer.positions, grid.triangles), std::sqrt(2.5 / 2), 1e-6);
  // Coordinates made for the longer surface.
  EXPECT_NEAR(*textureStretch(flatCoordinates(grid, 2, 1), longer.positions, grid.triangles), 1, 1e-6);
}

TEST(TextureStretch, WithoutAnAreaThereIsNone) {
  const TriMesh grid = flatGrid(3, 3);
  EXPECT_FALSE(
      textureStretch(std::vector<Vec2f>(grid.positions.size(), Vec2f(0.5f, 0.5f)), grid.positions, grid.triangles));
  EXPECT_FALSE(textureStretch(flatCoordinates(grid), grid.positions, {}));
}

}  // namespace
}  // namespace limber
