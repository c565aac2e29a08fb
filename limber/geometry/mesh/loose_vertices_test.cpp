#include "limber/geometry/mesh/loose_vertices.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(LooseVertices, AreLeftOutAndTheOthersKeepTheirOrder) {
  TriMesh mesh;
  for (int v = 0; v < 6; ++v) mesh.positions.push_back({static_cast<float>(v), 0, 0});
  mesh.triangles = {{5, 1, 3}, {1, 4, 3}};
  const std::optional<BareSurface> surface = withoutLooseVertices(mesh);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->source, (std::vector<Index>{1, 3, 4, 5}));
  EXPECT_EQ(surface->mesh.triangles, (std::vector<Triangle>{{3, 0, 1}, {0, 2, 1}}));
  for (Index v = 0; v < 4; ++v) EXPECT_EQ(surface->mesh.positions[v], mesh.positions[surface->source[v]]);
}

TEST(LooseVertices, AMeshWithoutThemOrWithoutTrianglesIsLeftAsItIs) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_FALSE(withoutLooseVertices(mesh));
  mesh.triangles = {{0, 1, 2}};
  EXPECT_FALSE(withoutLooseVertices(mesh));
}

}  // namespace
}  // namespace limber
