#include "limber/geometry/surface/surface_distance.h"

#include <map>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

// A square sheet of `cells` by `cells`, 1 m wide, at height z.
TriMesh sheet(Index cells, float z) {
  TriMesh mesh;
  for (Index y = 0; y <= cells; ++y) {
    for (Index x = 0; x <= cells; ++x) {
      mesh.positions.push_back({static_cast<float>(x) / cells, static_cast<float>(y) / cells, z});
    }
  }
  const auto at = [&](Index x, Index y) { return y * (cells + 1) + x; };
  for (Index y = 0; y < cells; ++y) {
    for (Index x = 0; x < cells; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
  return mesh;
}

TEST(SurfaceDistance, IsTheStraightLineOnAFlatSheet) {
  const SurfaceDistance distance(sheet(20, 0));
  const Index triangle = 2 * (10 * 20 + 10);
  const Vec3 barycentric(0.5, 0.2, 0.3);
  Vec3 source = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    source += barycentric[k] * distance.mesh().position(distance.mesh().triangles[triangle][k]);
  }
  const std::vector<VertexDistance> found = distance.within(triangle, barycentric, 0.35);
  std::map<Index, double> distances;
  for (const VertexDistance& v : found) distances[v.vertex] = v.distance;
  for (Index v = 0; v < distance.mesh().vertexCount(); ++v) {
    const double straight = (distance.mesh().position(v) - source).norm();
    if (straight < 0.34) {
      ASSERT_TRUE(distances.count(v)) << v;
      EXPECT_NEAR(distances[v], straight, 0.03 * straight + 0.002);
    } else if (straight > 0.35 + 1e-9) {
      EXPECT_FALSE(distances.count(v));
    }
  }
}

TEST(SurfaceDistance, DoesNotLeapToASheetOneMillimetreAway) {
  const TriMesh both = testing::joined(sheet(20, 0), sheet(20, 0.001f));
  const SurfaceDistance distance(both);
  for (const VertexDistance& v : distance.within(400, {0.3, 0.3, 0.4}, 0.5)) {
    EXPECT_LT(v.vertex, both.vertexCount() / 2);
  }
}

TEST(SurfaceDistance, ComesNearestFirst) {
  const SurfaceDistance distance(testing::subdivided(sheet(4, 0)));
  double last = 0;
  for (const VertexDistance& v : distance.within(3, {1, 0, 0}, 2)) {
    EXPECT_GE(v.distance, last);
    last = v.distance;
  }
}

TEST(SurfaceDistance, NeighboursShareAnEdge) {
  const SurfaceDistance distance(sheet(2, 0));
  EXPECT_EQ(distance.neighbours(4), (std::vector<Index>{0, 1, 3, 5, 7, 8}));
}

}  // namespace
}  // namespace limber
