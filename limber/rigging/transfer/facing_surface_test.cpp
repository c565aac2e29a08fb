#include "limber/rigging/transfer/facing_surface.h"

#include <gmock/gmock.h>

#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {

namespace {

// Two sheets close together, as both sides of a cloth: z = 0 faces down, z = 0.1 up.
TriMesh cloth() {
  TriMesh below = testing::flatGrid(4, 4);
  for (Triangle& t : below.triangles) std::swap(t[1], t[2]);
  return testing::join(below, testing::moved(testing::flatGrid(4, 4), {1, 1, 1}, {0, 0, 0.1f}));
}

TEST(FacingSurfaceTest, TakesTheSideThatFacesLikewise) {
  const FacingSurface surface(cloth());
  const Vec3 point(0.4, 0.3, 0.04);
  EXPECT_NEAR(surface.nearest(point).position.z(), 0, 1e-6);
  EXPECT_NEAR(surface.nearestFacing(point, Vec3(0.1, 0, 1))->position.z(), 0.1, 1e-6);
  EXPECT_NEAR(surface.nearestFacing(point, Vec3(0.1, 0, -1))->position.z(), 0, 1e-6);
}

TEST(FacingSurfaceTest, HasNothingForADirectionThatNoTriangleFaces) {
  const FacingSurface surface(cloth());
  EXPECT_FALSE(surface.nearestFacing(Vec3::Zero(), Vec3::UnitX()));
  EXPECT_FALSE(surface.nearestFacing(Vec3::Zero(), Vec3::Zero()));
}

TEST(FacingSurfaceTest, OnASphereBothAreTheSame) {
  const TriMesh sphere = testing::icosphere(3);
  const FacingSurface surface(sphere);
  for (Index v = 0; v < sphere.vertexCount(); v += 7) {
    const Vec3 point = 1.3 * sphere.position(v);
    const auto facing = surface.nearestFacing(point, point);
    ASSERT_TRUE(facing);
    EXPECT_LT((facing->position - surface.nearest(point).position).norm(), 1e-6);
  }
}

TEST(FacingSurfaceTest, TurnsWhatIsInsideOut) {
  TriMesh sphere = testing::icosphere(1);
  const std::vector<Triangle> outside = sphere.triangles;
  for (Triangle& t : sphere.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(facingOutwards(sphere).triangles, outside);
}

}  // namespace

}  // namespace limber
