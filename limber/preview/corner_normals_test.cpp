#include "limber/preview/corner_normals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {
namespace {

TEST(CornerNormals, ACubeKeepsItsSharpEdges) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                                           {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  const std::vector<Vec3f> normals = cornerNormals(positions, triangles);
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Vec3f a = positions[triangles[f][0]];
    const Vec3f face = (positions[triangles[f][1]] - a).cross(positions[triangles[f][2]] - a).normalized();
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LT((normals[3 * f + c] - face).norm(), 1e-6);
  }
}

// A cylinder whose triangles have no vertex index in common: equal positions count as one vertex.
TEST(CornerNormals, ARoundWallIsSmoothEvenUnwelded) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  constexpr int kAround = 24;
  const auto at = [](int i, float y) {
    const double turn = 2 * kPi * (i % kAround) / kAround;
    return Vec3f(float(std::cos(turn)), y, float(std::sin(turn)));
  };
  for (int i = 0; i < kAround; ++i) {
    for (const auto& corner : {at(i, 0), at(i, 1), at(i + 1, 1), at(i, 0), at(i + 1, 1), at(i + 1, 0)})
      positions.push_back(corner);
    const Index n = static_cast<Index>(positions.size());
    triangles.push_back({n - 6, n - 5, n - 4});
    triangles.push_back({n - 3, n - 2, n - 1});
  }
  const std::vector<Vec3f> normals = cornerNormals(positions, triangles);
  for (std::size_t c = 0; c < normals.size(); ++c) {
    const Vec3f radial(positions[c].x(), 0, positions[c].z());
    EXPECT_GT(normals[c].dot(radial), 0.995f);
  }
}

TEST(CornerNormals, ADegenerateFaceGetsNoNumberThatIsNotOne) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  for (const Vec3f& normal : cornerNormals(positions, std::vector<Triangle>{{0, 1, 2}}))
    EXPECT_EQ(normal, Vec3f(0, 0, 0));
}

}  // namespace
}  // namespace limber
