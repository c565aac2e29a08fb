#include "limber/rigging/roles/finger_count.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/capsule.h"

namespace limber {

namespace {

// A palm from the origin along +X, and so many fingers on it; tips at x = 0.2.
TriMesh handOf(int fingers) {
  TriMesh mesh;
  testing::addCapsule(mesh, {-0.3, 0, 0}, {0, 0, 0}, 0.03);  // the forearm
  testing::addCapsule(mesh, {0, 0, 0}, {0.07, 0, 0}, 0.045);
  for (int i = 0; i < fingers; ++i) {
    const double z = 0.024 * (i - 0.5 * (fingers - 1));
    testing::addCapsule(mesh, {0.08, 0, z}, {0.19, 0, z}, 0.01);
  }
  return mesh;
}

std::size_t counted(const TriMesh& mesh) {
  return countFingers(mesh, {0, 0, 0}, {0.2, 0, 0});
}

}  // namespace

TEST(FingerCount, CountsFingersThatAreApart) {
  for (const int fingers : {2, 3, 4}) EXPECT_EQ(counted(handOf(fingers)), static_cast<std::size_t>(fingers));
}

TEST(FingerCount, IsTheSameWhereTheTipIsRoughlyKnown) {
  for (const double x : {0.12, 0.15, 0.22}) EXPECT_EQ(countFingers(handOf(4), {0, 0, 0}, {x, 0, 0.01}), 4u) << x;
}

TEST(FingerCount, MittensAndFistsHaveNone) {
  TriMesh mitten;
  testing::addCapsule(mitten, {0, 0, 0}, {0.16, 0, 0}, 0.04);
  EXPECT_LT(counted(mitten), 2u);
  testing::addCapsule(mitten, {0.05, 0, 0.05}, {0.12, 0, 0.09}, 0.012);
  EXPECT_LT(counted(mitten), 3u) << "a thumb";
  EXPECT_EQ(counted(TriMesh()), 0u);
  EXPECT_EQ(countFingers(mitten, {0, 0, 0}, {0, 0, 0}), 0u);
}

TEST(FingerCount, PiecesInOneAnotherCountOnce) {
  TriMesh mesh = handOf(4);
  const TriMesh once = mesh;
  for (const Vec3f& position : once.positions) mesh.positions.push_back(position + Vec3f(0.001f, 0.001f, 0));
  for (const Triangle& t : once.triangles) {
    const Index first = once.vertexCount();
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  EXPECT_EQ(counted(mesh), 4u);
}

TEST(FingerCount, LimbsBesideTheHandAreNoFingers) {
  TriMesh mesh = handOf(4);
  for (const double y : {-0.3, 0.3}) testing::addCapsule(mesh, {-0.5, y, 0}, {0.5, y, 0}, 0.015);
  testing::addCapsule(mesh, {-0.5, 0.1, 0.1}, {0.5, 0.1, 0.1}, 0.06);
  EXPECT_EQ(counted(mesh), 4u);
}

}  // namespace limber
