#include "limber/geometry/mesh/normals.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

// A triangle in the plane z = 0 and one of four times its area in x = 0, over the edge from 0 to 1.
TEST(AreaNormals, WeighTrianglesByArea) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, -4}, {7, 7, 7}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 0, 3}};
  const std::vector<Vec3> normals = areaNormals<Vec3f>(positions, triangles);
  ASSERT_EQ(normals.size(), 5u);
  EXPECT_EQ(normals[2], Vec3(0, 0, 1));
  EXPECT_EQ(normals[3], Vec3(4, 0, 0));
  EXPECT_EQ(normals[0], Vec3(4, 0, 1));
  EXPECT_EQ(normals[1], Vec3(4, 0, 1));
  EXPECT_EQ(normals[4], Vec3(0, 0, 0));
}

}  // namespace
}  // namespace limber
