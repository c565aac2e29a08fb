#include "limber/geometry/surface/mirror_map.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

using testing::blockBiped;

void expectMirrors(const TriMesh& mesh, const MirrorMap& map, double tolerance) {
  ASSERT_EQ(map.image.size(), mesh.positions.size());
  EXPECT_NEAR(map.plane.normal.norm(), 1, 1e-9);
  for (Index v = 0; v < map.image.size(); ++v) {
    if (map.image[v] == kNoIndex) continue;
    ASSERT_EQ(map.image[map.image[v]], v);
    const Vec3 p = mesh.position(v);
    const Vec3 reflected = p - 2 * (map.plane.normal.dot(p) - map.plane.offset) * map.plane.normal;
    EXPECT_LE((reflected - mesh.position(map.image[v])).norm(), tolerance) << v;
  }
}

std::size_t unmatched(const MirrorMap& map) {
  return static_cast<std::size_t>(std::count(map.image.begin(), map.image.end(), kNoIndex));
}

TEST(MirrorMap, FindsImagesInAnyOrderOfVertices) {
  const TriMesh mesh = testing::shuffled(blockBiped(1));
  const auto map = findMirror(mesh);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->plane.normal, Vec3(1, 0, 0));
  EXPECT_EQ(map->plane.offset, 0);
  EXPECT_EQ(unmatched(*map), 0u);
  expectMirrors(mesh, *map, 0);
  for (Index v = 0; v < map->image.size(); ++v) EXPECT_EQ(map->image[v] == v, mesh.positions[v].x() == 0);
}

TEST(MirrorMap, FindsPlanesOffTheOriginAndAcrossOtherAxes) {
  TriMesh moved = blockBiped(1);
  for (Vec3f& p : moved.positions) p += Vec3f(7.25f, 1, 2);
  const auto map = findMirror(moved);
  ASSERT_TRUE(map);
  EXPECT_NEAR(map->plane.offset, 7.25, 1e-6);

  TriMesh turned = testing::jittered(blockBiped(1), 0);
  for (Vec3f& p : turned.positions) p = Vec3f(p.z() + 0.2f * p.y(), p.y(), p.x());  // slanted: z alone is left
  const auto turnedMap = findMirror(turned);
  ASSERT_TRUE(turnedMap);
  EXPECT_EQ(turnedMap->plane.normal, Vec3(0, 0, 1));
  expectMirrors(turned, *turnedMap, 1e-6);
}

TEST(MirrorMap, FindsSlantingPlanes) {
  TriMesh mesh = blockBiped(1);
  const Eigen::AngleAxisf turn(0.6f, Vec3f(1, 2, 3).normalized());
  for (Vec3f& p : mesh.positions)
    p = turn * Vec3f(p.x(), p.y(), p.z() + 0.1f * p.y() * p.y());  // front and back differ
  const auto map = findMirror(mesh);
  ASSERT_TRUE(map);
  EXPECT_NEAR(std::abs(map->plane.normal.dot((turn * Vec3f::UnitX()).cast<double>())), 1, 1e-4);
  expectMirrors(mesh, *map, 0.02);
}

// The positive side stays the model's left, whichever way it is turned a little.
TEST(MirrorMap, SlantingPlanesKeepTheSides) {
  for (const float degrees : {-20.0f, -7.0f, 3.0f, 11.0f}) {
    TriMesh mesh = blockBiped(1);
    const Eigen::AngleAxisf turn(degrees * 0.0174533f, Vec3f(0.3f, 1, 0.2f).normalized());
    for (Vec3f& p : mesh.positions) p = turn * Vec3f(p.x(), p.y(), p.z() + 0.1f * p.y() * p.y());
    const auto map = findMirror(mesh);
    ASSERT_TRUE(map);
    EXPECT_GT(map->plane.normal.x(), 0.9) << degrees;
  }
}

TEST(MirrorMap, AllowsForAFewVerticesAndALittleNoise) {
  TriMesh mesh = testing::jittered(blockBiped(2), 0.002f);
  const auto noisy = findMirror(mesh);
  ASSERT_TRUE(noisy);
  expectMirrors(mesh, *noisy, 0.02);
  mesh = blockBiped(2);
  mesh.positions[5] += Vec3f(0.1f, 0.2f, 0);
  const auto map = findMirror(mesh);
  ASSERT_TRUE(map);
  EXPECT_EQ(unmatched(*map), 2u);
}

// As in a scan or a sculpture: the same shape, vertices elsewhere.
TEST(MirrorMap, FindsSidesThatOnlyLookEqual) {
  TriMesh mesh = testing::jittered(blockBiped(2), 0.01f);
  for (Vec3f& p : mesh.positions) {
    p.z() += 0.1f * p.y() * p.y();  // front and back differ
    if (p.x() < -0.1f) p.y() += 0.08f;
  }
  const auto map = findMirror(mesh);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->plane.normal, Vec3(1, 0, 0));
  expectMirrors(mesh, *map, 0.3);
  EXPECT_LT(unmatched(*map), mesh.positions.size() / 10);
}

TEST(MirrorMap, SeesNoneWhereThereIsNone) {
  EXPECT_FALSE(findMirror(testing::jittered(testing::ball(3), 0.05f)));
  TriMesh lame = blockBiped(1);  // one arm shorter
  for (Vec3f& p : lame.positions) {
    if (p.x() > 2) p.x() = 2 + 0.7f * (p.x() - 2);
  }
  const auto map = findMirror(lame);
  EXPECT_TRUE(!map || std::abs(map->plane.normal.x()) < 0.1);
}

// All of its vertices lie in one row of cells, each of which holds hundreds.
TEST(MirrorMap, FindsImagesInALongRowOfPieces) {
  TriMesh row;
  constexpr int kPieces = 2500;
  for (int k = 0; k < kPieces; ++k) {
    const Vec3f at(static_cast<float>(k) - 0.5f * (kPieces - 1), 0, 0);
    const Index first = row.vertexCount();
    for (const Vec3f& corner : {Vec3f(-0.2f, 0, 0), Vec3f(0.2f, 0, 0), Vec3f(0, 0.3f, 0), Vec3f(0, 0, 0.5f)}) {
      row.positions.push_back(at + corner);
    }
    for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 3, 1}, Triangle{1, 3, 2}, Triangle{2, 3, 0}}) {
      row.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  const TriMesh mesh = testing::shuffled(row);
  const auto map = findMirror(mesh);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->plane.normal, Vec3(1, 0, 0));
  EXPECT_EQ(unmatched(*map), 0u);
  expectMirrors(mesh, *map, 1e-4);
}

// A bit a thousand times as far away as the model is large: all the rest is one point beside it.
TEST(MirrorMap, AFarBitHidesNothing) {
  const TriMesh plain = testing::shuffled(blockBiped(2));
  const auto expected = findMirror(plain);
  ASSERT_TRUE(expected);
  TriMesh bit = testing::octahedron();
  for (Vec3f& p : bit.positions) p *= 0.1f;
  const auto map = findMirror(testing::joined(plain, bit, Vec3f(5e3f, 1e4f, 0)));
  ASSERT_TRUE(map);
  EXPECT_EQ(map->plane.normal, expected->plane.normal);
  EXPECT_EQ(unmatched(*map), bit.positions.size());
  for (Index v = 0; v < plain.vertexCount(); ++v) ASSERT_EQ(map->image[v], expected->image[v]) << v;
}

TEST(MirrorMap, CanBeCancelled) {
  Progress progress;
  EXPECT_TRUE(findMirror(blockBiped(1), &progress));
  progress.cancel();
  EXPECT_FALSE(findMirror(blockBiped(1), &progress));
}

TEST(MirrorMap, ASheetIsNotTheImageOfItself) {
  const auto map = findMirror(testing::jittered(testing::flatGrid(12, 9), 0.2f));
  EXPECT_FALSE(map);
  TriMesh flat = testing::jittered(testing::flatGrid(12, 9), 0.2f);
  for (Vec3f& p : flat.positions) p.z() = 0;
  EXPECT_FALSE(findMirror(flat));
  EXPECT_FALSE(findMirror({{{1, 1, 1}, {1, 1, 1}}, {}}));
}

}  // namespace

}  // namespace limber
