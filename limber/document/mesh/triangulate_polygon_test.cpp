#include "limber/document/mesh/triangulate_polygon.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"

namespace limber {
namespace {

// The shoelace formula, of a polygon in the plane z = 0.
double areaOf(const std::vector<Vec3>& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

// All triangles turn as the polygon does, and together they have its area: then none overlaps another.
void expectCovered(const std::vector<Vec3>& corners) {
  for (const Mat3& turn :
       {Mat3(Mat3::Identity()), Mat3(Quat(0.5, 0.5, 0.5, 0.5)), Mat3(Quat(0.1, -0.7, 0.3, 0.2).normalized())}) {
    std::vector<Vec3> turned;
    for (const Vec3& corner : corners) turned.push_back(turn * corner);
    std::vector<std::array<Index, 3>> triangles;
    triangulatePolygon(turned, triangles);
    ASSERT_EQ(triangles.size(), corners.size() - 2);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
      const double area = areaOf({corners[a], corners[b], corners[c]});
      EXPECT_GE(area, -1e-12);
      sum += area;
    }
    EXPECT_NEAR(sum, areaOf(corners), 1e-9);
  }
}

TEST(TriangulatePolygon, ConvexOnes) {
  expectCovered({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}});
  expectCovered({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}});
  std::vector<Vec3> circle;
  for (int i = 0; i < 30; ++i) circle.emplace_back(std::cos(i * kPi / 15), std::sin(i * kPi / 15), 0);
  expectCovered(circle);
}

TEST(TriangulatePolygon, ConcaveOnesWhereverTheyBegin) {
  std::vector<Vec3> arrow = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0.5, 0}, {0, 2, 0}};
  std::vector<Vec3> dart = {{0, 0, 0}, {1, 0.2, 0}, {2, 0, 0}, {1, 3, 0}};
  std::vector<Vec3> comb = {{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 1, 0}, {3, 3, 0}, {2, 1, 0}, {1, 3, 0}, {0.5, 1, 0}};
  for (std::vector<Vec3>* polygon : {&arrow, &dart, &comb}) {
    for (std::size_t i = 0; i < polygon->size(); ++i) {
      expectCovered(*polygon);
      std::rotate(polygon->begin(), polygon->begin() + 1, polygon->end());
    }
  }
}

TEST(TriangulatePolygon, ASpiral) {
  std::vector<Vec3> spiral;
  for (int i = 0; i <= 100; ++i)
    spiral.emplace_back((1 + 0.05 * i) * std::cos(0.2 * i), (1 + 0.05 * i) * std::sin(0.2 * i), 0);
  for (int i = 100; i >= 0; --i)
    spiral.emplace_back((0.8 + 0.05 * i) * std::cos(0.2 * i), (0.8 + 0.05 * i) * std::sin(0.2 * i), 0);
  if (areaOf(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  expectCovered(spiral);
}

TEST(TriangulatePolygon, AQuadrangleIsCutAlongItsShorterDiagonal) {
  std::vector<std::array<Index, 3>> triangles;
  triangulatePolygon(std::vector<Vec3>{{0, 0, 0}, {3, -1, 0}, {6, 0, 0}, {3, 1, 0}}, triangles);
  EXPECT_EQ(triangles, (std::vector<std::array<Index, 3>>{{0, 1, 3}, {1, 2, 3}}));
}

TEST(TriangulatePolygon, WithoutAreaItIsAFan) {
  std::vector<std::array<Index, 3>> triangles;
  triangulatePolygon(std::vector<Vec3>(6, Vec3::Zero()), triangles);
  EXPECT_EQ(triangles.size(), 4u);
}

}  // namespace
}  // namespace limber
