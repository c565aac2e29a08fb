#include "limber/rigging/transfer/surface_registration.h"

#include <gmock/gmock.h>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {

namespace {

std::vector<Vec3> registered(const TriMesh& source, const TriMesh& target) {
  Progress progress;
  return registerSurface(source, {}, target, {}, progress);
}

TEST(SurfaceRegistrationTest, LeavesAPairThatFitsAlone) {
  const TriMesh sphere = testing::icosphere(2);
  const std::vector<Vec3> moved = registered(sphere, sphere);
  for (Index v = 0; v < sphere.vertexCount(); ++v) ASSERT_LT((moved[v] - sphere.position(v)).norm(), 1e-5);
}

TEST(SurfaceRegistrationTest, LaysASphereOnAnEgg) {
  const TriMesh sphere = testing::icosphere(3);
  const TriMesh egg = testing::moved(testing::icosphere(4), {1.1f, 1.3f, 0.85f}, {0.05f, 0, 0});
  const Bvh surface(egg);
  const std::vector<Vec3> moved = registered(sphere, egg);
  for (const Vec3& p : moved) ASSERT_LT(surface.nearestPoint(p).distance, 0.02);
  // Neighbours stay neighbours: no triangle is turned over.
  for (const auto& [a, b, c] : sphere.triangles) {
    ASSERT_GT((moved[b] - moved[a]).cross(moved[c] - moved[a]).dot(moved[a] + moved[b] + moved[c]), 0);
  }
}

TEST(SurfaceRegistrationTest, TakesOpenSurfacesAndLooseVertices) {
  TriMesh tube = testing::tube(12, 9, false);
  tube.positions.push_back({0, 3, 0});
  const TriMesh target = testing::moved(testing::tube(20, 30, true), {1.2f, 1.1f, 1.1f}, {0, 0, 0});
  for (const Vec3& p : registered(tube, target)) ASSERT_TRUE(p.allFinite());
}

}  // namespace

}  // namespace limber
