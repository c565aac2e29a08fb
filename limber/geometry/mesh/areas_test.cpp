#include "limber/geometry/mesh/areas.h"

#include <numeric>

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(Areas, ATriangleHasHalfTheAreaOfItsParallelogram) {
  EXPECT_DOUBLE_EQ(triangleArea(Vec3(1, 1, 1), Vec3(4, 1, 1), Vec3(1, 1, 5)), 6);
  EXPECT_DOUBLE_EQ(triangleArea(Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2)), 0);
}

TEST(Areas, VerticesShareTheAreaOfTheirTriangles) {
  // A unit square of two triangles, with a vertex that belongs to none.
  const TriMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 9, 9}}, {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<double> areas = vertexAreas(mesh);
  ASSERT_EQ(areas.size(), 5u);
  EXPECT_DOUBLE_EQ(areas[0], 1.0 / 3);
  EXPECT_DOUBLE_EQ(areas[1], 1.0 / 6);
  EXPECT_DOUBLE_EQ(areas[2], 1.0 / 3);
  EXPECT_DOUBLE_EQ(areas[3], 1.0 / 6);
  EXPECT_EQ(areas[4], 0);
  EXPECT_DOUBLE_EQ(std::accumulate(areas.begin(), areas.end(), 0.0), 1);
}

}  // namespace
}  // namespace limber
