#include "limber/geometry/surface/surface_component.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

TEST(SurfaceComponents, TheLargestIsFirstAndLooseVerticesAreNone) {
  TriMesh mesh = testing::joined(testing::octahedron(), testing::flatGrid(4, 3), {0, 5, 0});
  mesh.positions.emplace_back(9, 9, 9);
  const SurfaceComponents components = SurfaceComponents::of(mesh);
  ASSERT_EQ(components.list.size(), 2u);
  const SurfaceComponent &grid = components.list[0], &solid = components.list[1];
  EXPECT_EQ(grid.vertices.size(), 20u);
  EXPECT_EQ(grid.vertices.front(), 6u);
  EXPECT_EQ(grid.triangles.size(), 24u);
  EXPECT_DOUBLE_EQ(grid.area, 12);
  EXPECT_EQ(grid.box.size(), Vec3(4, 3, 0));
  EXPECT_EQ(solid.triangles.size(), 8u);
}

TEST(SurfaceComponents, SamplesAreMiddlesOfTriangles) {
  const TriMesh mesh = testing::flatGrid(4, 3);
  const SurfaceComponents components = SurfaceComponents::of(mesh);
  EXPECT_EQ(areaSamplesOf(mesh, components.list[0], 100).size(), 24u);
  const std::vector<AreaSample> samples = areaSamplesOf(mesh, components.list[0], 5);
  ASSERT_EQ(samples.size(), 5u);
  for (const AreaSample& sample : samples) EXPECT_DOUBLE_EQ(sample.area, 0.5);
}

}  // namespace
}  // namespace limber
