#include "limber/rigging/sphere_mesh/joined_nodes.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

using testing::TestRandom;

// Nodes on a square grid of unit side, in pairs but those of the first column, each next to those beside and above it.
CollapseStart sheet(Index side) {
  CollapseStart start;
  TestRandom random(1);
  for (Index y = 0; y < side; ++y) {
    for (Index x = 0; x < side; ++x) {
      const Index node = y * side + x;
      const Vec3 center(double(x) / side, double(y) / side, 0);
      start.nodeCenters.push_back(center.cast<float>());
      start.input.single.push_back(x == 0);
      start.input.quadrics.emplace_back().addPlane(center, Vec3::UnitZ(), random.unit());
      start.input.moments.emplace_back().addPoint(center, random.unit());
      if (x > 0) start.input.edges.push_back({node - 1, makeEnd(node, false)});
      if (y > 0) start.input.edges.push_back({node - side, makeEnd(node, false)});
      if (x == 1) start.input.edges.push_back({node, makeEnd(node, true)});
      start.vertexEnds.push_back(makeEnd(node, false));
      if (x > 0) start.vertexEnds.push_back(makeEnd(node, true));
    }
  }
  for (const GraphEdge& e : start.input.edges) start.input.borders.push_back(1 + (e.from + 3 * e.to) % 17);
  start.loose.push_back({0, side * side - 1});
  return start;
}

double weightOf(const CollapseStart& start) {
  double sum = 0;
  for (const SphereQuadric& quadric : start.input.quadrics) sum += quadric.weight();
  return sum;
}

TEST(JoinNearNodes, LeavesAFewAsTheyAre) {
  const CollapseStart start = sheet(10), joined = joinNearNodes(start, 100);
  EXPECT_EQ(joined.nodeCenters.size(), 100u);
  EXPECT_EQ(joined.input.edges.size(), start.input.edges.size());
}

TEST(JoinNearNodes, MakesClustersOfOneKindThatWeighAsMuch) {
  const CollapseStart start = sheet(64), joined = joinNearNodes(start, 400);
  const std::size_t count = joined.nodeCenters.size();
  // 16 cells a side, the first column's nodes apart from the pairs beside them.
  EXPECT_EQ(count, 16u * 16u + 16u);
  EXPECT_NEAR(weightOf(joined), weightOf(start), 1e-9);
  ASSERT_EQ(joined.vertexEnds.size(), start.vertexEnds.size());
  for (std::size_t v = 0; v < joined.vertexEnds.size(); ++v) {
    const Index node = nodeOf(start.vertexEnds[v]), cluster = nodeOf(joined.vertexEnds[v]);
    ASSERT_LT(cluster, count);
    EXPECT_EQ(crossesOf(joined.vertexEnds[v]), crossesOf(start.vertexEnds[v]));
    EXPECT_EQ(joined.input.single[cluster], start.input.single[node]);
    EXPECT_LT((joined.nodeCenters[cluster] - start.nodeCenters[node]).cwiseAbs().maxCoeff(), 1.0f / 16);
  }
  EXPECT_EQ(joined.loose.front().node, nodeOf(joined.vertexEnds.back()));
  std::set<std::pair<Index, EdgeEnd>> seen;
  std::size_t toOwnImages = 0;
  for (const GraphEdge& e : joined.input.edges) {
    EXPECT_TRUE(e.from < nodeOf(e.to) || (e.from == nodeOf(e.to) && crossesOf(e.to)));
    EXPECT_TRUE(seen.insert({e.from, e.to}).second);
    toOwnImages += e.from == nodeOf(e.to) ? 1 : 0;
  }
  EXPECT_EQ(toOwnImages, 16u);
  ASSERT_EQ(joined.input.borders.size(), joined.input.edges.size());
  std::vector<Index> clusters(start.nodeCenters.size());
  for (std::size_t v = 0; v < joined.vertexEnds.size(); ++v) {
    clusters[nodeOf(start.vertexEnds[v])] = nodeOf(joined.vertexEnds[v]);
  }
  Border between = 0, joinedBorders = 0;
  for (std::size_t e = 0; e < start.input.edges.size(); ++e) {
    const GraphEdge& edge = start.input.edges[e];
    if (crossesOf(edge.to) || clusters[edge.from] != clusters[nodeOf(edge.to)]) between += start.input.borders[e];
  }
  for (const Border border : joined.input.borders) joinedBorders += border;
  EXPECT_EQ(joinedBorders, between);
}

TEST(JoinNearNodes, JoinsNoNodesThatDoNotHangTogether) {
  CollapseStart start = sheet(64);
  start.input.edges.clear();
  EXPECT_EQ(joinNearNodes(start, 400).nodeCenters.size(), start.nodeCenters.size());
}

}  // namespace
}  // namespace limber
