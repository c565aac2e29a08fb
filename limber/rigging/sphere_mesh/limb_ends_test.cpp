#include "limber/rigging/sphere_mesh/limb_ends.h"

#include <array>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/testing/sphere_mesh_of.h"

namespace limber {

namespace {

using Cells = std::set<std::array<int, 3>>;

constexpr int kSeat = 7, kLegs = 8;  // cells: the seat's width, the legs' length

Cells stoolCells() {
  Cells cells;
  for (int x = 0; x < kSeat; ++x) {
    for (int z = 0; z < kSeat; ++z) cells.insert({x, kLegs, z});
  }
  for (const int x : {0, kSeat - 1}) {
    for (const int z : {0, kSeat - 1}) {
      for (int y = 0; y < kLegs; ++y) cells.insert({x, y, z});
    }
  }
  return cells;
}

// A graph without symmetry, of the mesh's vertices, each with a third of its triangles' area; longest side 1.
SphereGraph graphOf(const TriMesh& mesh) {
  SphereGraph graph;
  const Box box = [&] {
    Box all;
    for (Index v = 0; v < mesh.vertexCount(); ++v) all.add(mesh.position(v));
    return all;
  }();
  const float scale = static_cast<float>(1 / box.longestSide());
  for (const Vec3f& p : mesh.positions) graph.centers.push_back(scale * p);
  graph.areas.assign(mesh.positions.size(), 0);
  graph.single.assign(mesh.positions.size(), 1);
  for (const Triangle& t : mesh.triangles) {
    const Vec3f u = graph.centers[t[1]] - graph.centers[t[0]], v = graph.centers[t[2]] - graph.centers[t[0]];
    for (int k = 0; k < 3; ++k) {
      graph.areas[t[k]] += u.cross(v).norm() / 6;
      graph.edges.push_back({t[k], makeEnd(t[(k + 1) % 3], false)});
    }
  }
  return graph;
}

}  // namespace

TEST(LimbEnds, AreTheFeetOfAStool) {
  const TriMesh mesh = testing::cubes(stoolCells());
  const std::vector<LimbEnd> ends = limbEnds(graphOf(mesh));
  ASSERT_EQ(ends.size(), 4u);
  std::set<std::pair<bool, bool>> legs;
  for (const LimbEnd& end : ends) {
    EXPECT_GT(end.length, 0.6 * kLegs / (kLegs + 1.0));
    EXPECT_LT(end.thickness, 0.3);
    ASSERT_FALSE(end.nodes.empty());
    for (const Index node : end.nodes) {
      EXPECT_LT(mesh.positions[node].y(), kLegs);
      legs.insert({mesh.positions[node].x() > 3.5f, mesh.positions[node].z() > 3.5f});
    }
  }
  EXPECT_EQ(legs.size(), 4u) << "one each";
}

TEST(LimbEnds, BallsAndBoxesHaveNone) {
  EXPECT_TRUE(limbEnds(graphOf(testing::ball(3))).empty());
  Cells cube;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      for (int z = 0; z < 5; ++z) cube.insert({x, y, z});
    }
  }
  EXPECT_TRUE(limbEnds(graphOf(testing::cubes(cube))).empty());
}

TEST(LimbEnds, ABranchedLimbIsAsLongAsAllOfIt) {
  // A rod that forks: three ends, and the longest goes on beyond the fork.
  Cells cells;
  for (int y = 0; y < 20; ++y) cells.insert({0, y, 0});
  for (int x = 1; x < 8; ++x) {
    cells.insert({x, 19, 0});
    cells.insert({-x, 19, 0});
  }
  const std::vector<LimbEnd> ends = limbEnds(graphOf(testing::cubes(cells)));
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_GT(ends.front().length, ends.back().length);
  for (const LimbEnd& end : ends) EXPECT_LE(end.ownLength, end.length);
}

TEST(LimbEnds, EachHasAHandleOfItsOwnAtEveryCountThatSuffices) {
  for (const bool isSymmetric : {true, false}) {
    TriMesh mesh = testing::subdivided(testing::cubes(stoolCells()));
    if (!isSymmetric) mesh = testing::jittered(mesh, 0.1f);
    const SphereMesh spheres = testing::sphereMeshOf(mesh);
    ASSERT_EQ(spheres.mirror().has_value(), isSymmetric);
    for (Index count = 6; count <= 24; ++count) {
      SCOPED_TRACE(std::to_string(count) + (isSymmetric ? " handles" : " handles, not symmetric"));
      const std::vector<Index> handles = spheres.vertexHandles(count);
      const auto legOf = [&](Index v) {  // 0 to 3; 4: the seat
        const Vec3f& p = mesh.positions[v];
        return p.y() > kLegs - 0.5f ? 4 : 2 * (p.x() > 3.5f) + (p.z() > 3.5f);
      };
      std::array<std::set<Index>, 5> used;
      for (Index v = 0; v < mesh.vertexCount(); ++v) used[legOf(v)].insert(handles[v]);
      for (int leg = 0; leg < 4; ++leg) {
        const bool hasItsOwn = std::any_of(used[leg].begin(), used[leg].end(), [&](Index handle) {
          for (int other = 0; other < 5; ++other) {
            if (other != leg && used[other].contains(handle)) return false;
          }
          return true;
        });
        EXPECT_TRUE(hasItsOwn) << "leg " << leg;
      }
    }
    EXPECT_EQ(spheres.limbs().limbs, 4u);
    EXPECT_LE(spheres.limbs().fewestHandles, 6u);
    EXPECT_GE(spheres.limbs().fewestHandles, 5u);  // four feet and the seat
  }
}

// A seat of legs that differ by a cell: none goes before the others because of that.
TEST(LimbEnds, OfAboutTheSameLengthAreLostForTheSame) {
  Cells cells = stoolCells();
  for (const int x : {0, kSeat - 1}) cells.erase({x, 0, 0});
  const SphereMesh spheres = testing::sphereMeshOf(testing::subdivided(testing::cubes(cells)));
  Index limbs = 0;
  for (const LostEnd& end : spheres.sequence().lostEnds) {
    limbs += end.limbs;
    EXPECT_EQ(end.length, spheres.sequence().lostEnds.front().length);
  }
  EXPECT_EQ(limbs, 4u);
}

TEST(LimbEnds, AModelWithoutLimbsNeedsOneHandle) {
  const LimbCount limbs = testing::sphereMeshOf(testing::ball(3)).limbs();
  EXPECT_EQ(limbs.limbs, 0u);
  EXPECT_EQ(limbs.fewestHandles, 1u);
}

}  // namespace limber
