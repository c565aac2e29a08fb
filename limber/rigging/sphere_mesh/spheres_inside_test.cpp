// A rim, whose few spheres have their centres in the air, and what has nothing to move.
#include "limber/rigging/sphere_mesh/spheres_inside.h"

#include <array>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/winding_number.h"
#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/testing/sphere_mesh_of.h"

namespace limber {
namespace {

constexpr int kWidth = 9;  // cells

// A square ring of cells, one thick.
TriMesh rim() {
  std::set<std::array<int, 3>> cells;
  for (int i = 0; i < kWidth; ++i) {
    for (const int side : {0, kWidth - 1}) {
      cells.insert({i, 0, side});
      cells.insert({side, 0, i});
    }
  }
  return testing::cubes(cells);
}

struct Moved {
  SphereMeshLevel before, after;
  std::vector<Index> sphereOf;
  std::optional<MirrorPlane> mirror;
};

Moved moved(const TriMesh& mesh, Index count) {
  const SphereMesh spheres = testing::sphereMeshOf(mesh);
  Moved result;
  result.before = result.after = spheres.level(count);
  result.sphereOf = spheres.vertexHandles(count);
  result.mirror = spheres.mirror();
  moveSpheresInside(result.after, mesh, result.sphereOf, result.mirror);
  return result;
}

Index nearestVertex(const TriMesh& mesh, const Vec3& point) {
  Index nearest = 0;
  for (Index v = 1; v < mesh.vertexCount(); ++v) {
    if ((mesh.position(v) - point).norm() < (mesh.position(nearest) - point).norm()) nearest = v;
  }
  return nearest;
}

TEST(SpheresInside, OfARimAreInTheRim) {
  const TriMesh mesh = rim();
  const WindingNumber winding(mesh);
  ASSERT_LT(winding.at(moved(mesh, 1).before.spheres[0].center), 0.5) << "one sphere is in the middle of the ring";
  for (Index count = 1; count <= 8; ++count) {
    SCOPED_TRACE(count);
    const Moved rig = moved(mesh, count);
    for (Index h = 0; h < count; ++h) {
      const Sphere& sphere = rig.after.spheres[h];
      EXPECT_GT(winding.at(sphere.center), 0.5);
      EXPECT_EQ(rig.sphereOf[nearestVertex(mesh, sphere.center)], h) << "within its own part";
      const bool wasOutside = winding.at(rig.before.spheres[h].center) < 0.5;
      EXPECT_LE(sphere.radius, wasOutside ? 0.51 : 1) << "half as thick as the rim";
    }
  }
}

TEST(SpheresInside, ImagesStayImages) {
  const TriMesh mesh = rim();
  Index pairs = 0;
  for (Index count = 1; count <= 8; ++count) {
    const Moved rig = moved(mesh, count);
    ASSERT_TRUE(rig.mirror);
    for (Index h = 0; h < count; ++h) {
      const Index image = rig.after.images[h];
      const Vec3 &p = rig.after.spheres[h].center, &q = rig.after.spheres[image].center;
      EXPECT_NEAR(rig.mirror->normal.dot(p) + rig.mirror->normal.dot(q), 2 * rig.mirror->offset, 1e-6);
      EXPECT_EQ(rig.after.spheres[h].radius, rig.after.spheres[image].radius);
      pairs += image != h;
    }
  }
  EXPECT_GT(pairs, 0u);
}

TEST(SpheresInside, APairDoesNotMeetOnThePlane) {
  const TriMesh mesh = rim();
  const std::vector<Index> all(mesh.positions.size(), 0);  // the middle of the part is the middle of the rim
  const double middle = 0.5 * kWidth;
  SphereMeshLevel level;
  level.spheres = {{Vec3(middle + 2, 0.5, middle), 1}, {Vec3(middle - 2, 0.5, middle), 1}};
  level.images = {1, 0};
  const MirrorPlane plane = {Vec3::UnitX(), middle};
  for (const double front : {0.0, 1.0}) {  // all of the rim, and the bar at z = 0 alone
    std::vector<Index> sphereOf = all;
    for (Index v = 0; v < sphereOf.size(); ++v) {
      if (front > 0 && mesh.position(v).z() > front) sphereOf[v] = 7;
    }
    moveSpheresInside(level, mesh, sphereOf, plane);
    const Sphere &one = level.spheres[0], &other = level.spheres[1];
    EXPECT_GE((one.center - other.center).norm(), one.radius - 1e-9);
    EXPECT_GT(one.center.x(), middle);
  }
}

TEST(SpheresInside, WhatIsInsideAndWhatHasNoInsideStays) {
  for (const TriMesh& mesh : {testing::blockBiped(1), testing::flatGrid(9, 9)}) {
    for (const Index count : {1u, 4u, 12u}) {
      const Moved rig = moved(mesh, count);
      for (Index h = 0; h < count; ++h) EXPECT_EQ(rig.after.spheres[h].center, rig.before.spheres[h].center);
    }
  }
}

}  // namespace
}  // namespace limber
