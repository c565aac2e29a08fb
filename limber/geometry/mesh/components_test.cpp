// Pieces of small meshes, against their obvious count.
#include "limber/geometry/mesh/components.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TriMesh meshOf(Index vertexCount, std::vector<Triangle> triangles) {
  TriMesh mesh;
  mesh.positions.resize(vertexCount, Vec3f::Zero());
  mesh.triangles = std::move(triangles);
  return mesh;
}

TEST(Components, SharedVertexJoinsTriangles) {
  Index count = 0;
  EXPECT_EQ(vertexComponents(meshOf(5, {{0, 1, 2}, {2, 3, 4}}), &count), (std::vector<Index>{0, 0, 0, 0, 0}));
  EXPECT_EQ(count, 1u);
}

TEST(Components, NumbersFollowTheLowestVertex) {
  Index count = 0;
  EXPECT_EQ(vertexComponents(meshOf(7, {{6, 3, 1}, {5, 2, 0}}), &count), (std::vector<Index>{0, 1, 0, 1, 2, 0, 1}));
  EXPECT_EQ(count, 3u);  // vertex 4 is alone
}

TEST(Components, LateLinksMergeLongChains) {
  // Two strips over even and odd vertices, joined only by the last triangle.
  std::vector<Triangle> triangles;
  for (Index v = 0; v + 4 < 1000; ++v) triangles.push_back({v, v + 2, v + 4});
  Index count = 0;
  vertexComponents(meshOf(1000, triangles), &count);
  EXPECT_EQ(count, 2u);
  triangles.push_back({999, 998, 996});
  for (const Index piece : vertexComponents(meshOf(1000, triangles), &count)) EXPECT_EQ(piece, 0u);
  EXPECT_EQ(count, 1u);
}

TEST(Components, EmptyMesh) {
  Index count = 7;
  EXPECT_TRUE(vertexComponents(TriMesh{}, &count).empty());
  EXPECT_EQ(count, 0u);
}

}  // namespace
}  // namespace limber
