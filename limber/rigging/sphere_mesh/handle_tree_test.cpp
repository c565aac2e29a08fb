#include "limber/rigging/sphere_mesh/handle_tree.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/testing/sphere_mesh_of.h"

namespace limber {

namespace {

using testing::sphereMeshOf;

void expectTree(const HandleTree& tree, std::size_t count) {
  ASSERT_EQ(tree.order.size(), count);
  ASSERT_EQ(tree.parents.size(), count);
  EXPECT_EQ(std::set<Index>(tree.order.begin(), tree.order.end()).size(), count);
  EXPECT_FALSE(tree.parents[0]);
  for (std::size_t j = 1; j < count; ++j) {
    ASSERT_TRUE(tree.parents[j]);
    EXPECT_LT(*tree.parents[j], j);
  }
}

// Spheres of radius 1 at the given positions, joined by `edges`.
SphereMeshLevel levelOf(const std::vector<Vec3>& centers, std::vector<VertexPair> edges) {
  SphereMeshLevel level;
  for (const Vec3& c : centers) {
    level.spheres.push_back({c, 1});
    level.weights.push_back(1.0 / static_cast<double>(centers.size()));
  }
  level.edges = std::move(edges);
  return level;
}

std::set<VertexPair> linksOf(const HandleTree& tree) {
  std::set<VertexPair> links;
  for (std::size_t j = 1; j < tree.order.size(); ++j) {
    const Index a = tree.order[j], b = tree.order[*tree.parents[j]];
    links.insert({std::min(a, b), std::max(a, b)});
  }
  return links;
}

TEST(HandleTree, IsATreeWithParentsFirstAtEveryCount) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    const SphereMesh spheres = sphereMeshOf(mesh);
    for (Index count = 1; count <= std::min<Index>(80, mesh.vertexCount()); ++count) {
      expectTree(handleTree(spheres.level(count)), count);
    }
    expectTree(handleTree(spheres.level(mesh.vertexCount())), mesh.vertexCount());
  }
}

TEST(HandleTree, UsesOnlyNeighborsWithoutSymmetry) {
  const SphereMesh spheres = sphereMeshOf(testing::jittered(testing::blockBiped(1), 0.4f));
  ASSERT_FALSE(spheres.mirror());
  const SphereMeshLevel level = spheres.level(40);
  const std::set<VertexPair> edges(level.edges.begin(), level.edges.end());
  const HandleTree tree = handleTree(level);
  for (std::size_t j = 1; j < 40; ++j) {
    const Index a = tree.order[j], b = tree.order[*tree.parents[j]];
    EXPECT_TRUE(edges.count({std::min(a, b), std::max(a, b)}));
  }
}

TEST(HandleTree, IsItsOwnMirrorImage) {
  const SphereMesh spheres = sphereMeshOf(testing::blockBiped(1));
  for (Index count = 1; count <= 150; ++count) {
    const SphereMeshLevel level = spheres.level(count);
    const HandleTree tree = handleTree(level);
    const std::set<VertexPair> links = linksOf(tree);
    for (const auto& [a, b] : links) {
      const Index x = level.images[a], y = level.images[b];
      EXPECT_TRUE(links.count({std::min(x, y), std::max(x, y)})) << count;
    }
    const Index root = tree.order[0];
    const bool anyOnPlane = [&] {
      for (Index h = 0; h < count; ++h) {
        if (level.images[h] == h) return true;
      }
      return false;
    }();
    EXPECT_EQ(level.images[root] == root, anyOnPlane) << count;
  }
}

TEST(HandleTree, PrefersShortLinks) {
  // A square with one diagonal: the longest edge of each cycle is left out.
  const SphereMeshLevel level =
      levelOf({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 9, 0}}, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}});
  EXPECT_EQ(linksOf(handleTree(level)), (std::set<VertexPair>{{0, 1}, {1, 2}, {2, 3}}));
}

TEST(HandleTree, PrefersLongBorders) {
  SphereMeshLevel level = levelOf({{0, 0, 0}, {2, 0, 0}, {9, 0, 0}}, {{0, 1}, {0, 2}, {1, 2}});
  level.borders = {0.1, 3, 2};
  EXPECT_EQ(linksOf(handleTree(level)), (std::set<VertexPair>{{0, 2}, {1, 2}}));
  level.borders = {0, 3, 0};  // of what has no border the narrower gap
  EXPECT_EQ(linksOf(handleTree(level)), (std::set<VertexPair>{{0, 1}, {0, 2}}));
}

// A trunk of 0 and 1 on the plane, hips 2 and 3, a tail 4 that meets these alone, far from 1 and near to 0.
TEST(HandleTree, OnThePlaneWhatMeetsByWayOfAPairIsJoined) {
  SphereMeshLevel level =
      levelOf({{0, 0, 0}, {0, 9, 0}, {3, 9, 0}, {-3, 9, 0}, {0, 3, -3}}, {{0, 1}, {1, 2}, {1, 3}, {2, 4}, {3, 4}});
  level.images = {0, 1, 3, 2, 4};
  level.borders = {1, 1, 1, 1, 1};
  EXPECT_EQ(linksOf(handleTree(level)), (std::set<VertexPair>{{0, 1}, {1, 2}, {1, 3}, {1, 4}}));
}

TEST(HandleTree, TheRootIsInTheMiddle) {
  std::vector<Vec3> chain;
  std::vector<VertexPair> edges;
  for (Index i = 0; i < 9; ++i) {
    chain.push_back({3.0 * i, 0, 0});
    if (i > 0) edges.push_back({i - 1, i});
  }
  EXPECT_EQ(handleTree(levelOf(chain, edges)).order[0], 4u);
  // A heavy end draws it.
  SphereMeshLevel heavy = levelOf(chain, edges);
  heavy.weights[8] = 5;
  EXPECT_EQ(handleTree(heavy).order[0], 8u);
}

TEST(HandleTree, LimbsHangTogether) {
  // From every handle in a leg or an arm the path to the root stays in that limb until it leaves it for good.
  const SphereMesh spheres = sphereMeshOf(testing::blockBiped(2));
  const auto limbOf = [](const Vec3& c) {
    if (c.y() < 3.8) return c.x() > 0 ? 1 : 2;
    if (std::abs(c.x()) > 2.2) return c.x() > 0 ? 3 : 4;
    return 0;
  };
  for (const Index count : {10u, 20u, 30u, 50u}) {
    const SphereMeshLevel level = spheres.level(count);
    const HandleTree tree = handleTree(level);
    EXPECT_EQ(limbOf(level.spheres[tree.order[0]].center), 0);
    for (std::size_t j = 1; j < count; ++j) {
      const int limb = limbOf(level.spheres[tree.order[j]].center);
      const int parentLimb = limbOf(level.spheres[tree.order[*tree.parents[j]]].center);
      EXPECT_TRUE(parentLimb == limb || parentLimb == 0) << count << ": " << limb << " on " << parentLimb;
    }
  }
}

}  // namespace

}  // namespace limber
