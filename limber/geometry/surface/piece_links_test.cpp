#include "limber/geometry/surface/piece_links.h"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/point_tree.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

using testing::TestRandom;

std::vector<Vec3f> randomPoints(Index count, std::uint64_t seed) {
  TestRandom random(seed);
  std::vector<Vec3f> points;
  for (Index i = 0; i < count; ++i) {
    points.push_back(Vec3(random.unit(), random.unit(), random.unit()).cast<float>());
  }
  return points;
}

// Total length of a minimum spanning tree of the pieces, by Prim's algorithm over all points (edges within a piece
// cost nothing).
double spanningLength(const std::vector<Vec3f>& points, const std::vector<Index>& pieces) {
  std::vector<double> cost(points.size(), std::numeric_limits<double>::infinity());
  std::vector<bool> in(points.size(), false);
  cost[0] = 0;
  double total = 0;
  for (std::size_t step = 0; step < points.size(); ++step) {
    std::size_t next = points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!in[i] && (next == points.size() || cost[i] < cost[next])) next = i;
    }
    in[next] = true;
    total += cost[next];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = pieces[i] == pieces[next] ? 0 : (points[i] - points[next]).cast<double>().norm();
      if (!in[i]) cost[i] = std::min(cost[i], d);
    }
  }
  return total;
}

std::vector<Index> piecesOf(std::size_t count, const std::vector<VertexPair>& edges) {
  std::vector<Index> pieces(count);
  std::iota(pieces.begin(), pieces.end(), Index{0});
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : edges) {
      const Index least = std::min(pieces[a], pieces[b]);
      changed |= pieces[a] != least || pieces[b] != least;
      pieces[a] = pieces[b] = least;
    }
  }
  return pieces;
}

TEST(PieceLinks, NothingToDoForOnePiece) {
  EXPECT_TRUE(pieceLinks(randomPoints(3, 1), std::vector<VertexPair>{{0, 1}, {1, 2}}).empty());
  EXPECT_TRUE(pieceLinks(randomPoints(1, 1), {}).empty());
}

TEST(PieceLinks, AreAMinimumSpanningTreeOfLoosePoints) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Vec3f> points = randomPoints(200, seed);
    const std::vector<VertexPair> links = pieceLinks(points, {});
    ASSERT_EQ(links.size(), points.size() - 1);
    double length = 0;
    for (const auto& [a, b] : links) length += (points[a] - points[b]).cast<double>().norm();
    EXPECT_NEAR(length, spanningLength(points, piecesOf(points.size(), {})), 1e-5);
  }
}

TEST(PieceLinks, JoinPiecesWhereTheyAreNearest) {
  // Twelve short chains far apart against their edges.
  std::vector<Vec3f> points;
  std::vector<VertexPair> edges;
  for (const Vec3f& p : randomPoints(12, 9)) {
    for (int i = 0; i < 5; ++i) {
      if (i > 0) edges.push_back({static_cast<Index>(points.size() - 1), static_cast<Index>(points.size())});
      points.push_back(100 * p + static_cast<float>(i) * Vec3f(0.1f, 0.2f, 0));
    }
  }
  const std::vector<VertexPair> links = pieceLinks(points, edges);
  ASSERT_EQ(links.size(), 11u);
  double length = 0;
  for (const auto& [a, b] : links) length += (points[a] - points[b]).cast<double>().norm();
  EXPECT_NEAR(length, spanningLength(points, piecesOf(points.size(), edges)), 1e-3);
}

TEST(PieceLinks, SeamsAreStitchedAlongTheirLength) {
  const TriMesh sheet = testing::flatGrid(6, 1);
  const TriMesh two = testing::joined(sheet, sheet, {0, 1.01f, 0});
  std::vector<VertexPair> edges = surfaceEdges(two).edges;
  const std::vector<VertexPair> links = pieceLinks(two.positions, edges);
  EXPECT_EQ(links.size(), 7u);
  for (const auto& [a, b] : links) EXPECT_NEAR((two.positions[a] - two.positions[b]).norm(), 0.01f, 1e-4f);
}

TEST(PieceLinks, JoinThousandsOfPiecesIntoOne) {
  TriMesh mesh;
  TestRandom random(2);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 position(100 * random.unit(), 100 * random.unit(), 100 * random.unit());
    mesh = i % 500 == 0 ? testing::joined(mesh, testing::octahedron(), position.cast<float>()) : mesh;
    mesh.positions.push_back(position.cast<float>());
  }
  std::vector<VertexPair> edges = surfaceEdges(mesh).edges;
  const std::vector<VertexPair> links = pieceLinks(mesh.positions, edges);
  edges.insert(edges.end(), links.begin(), links.end());
  const std::vector<Index> pieces = piecesOf(mesh.positions.size(), edges);
  EXPECT_EQ(*std::max_element(pieces.begin(), pieces.end()), 0u);
}

TEST(PointTree, FindsEveryNearPairOfDifferentPiecesOnce) {
  const std::vector<Vec3f> points = randomPoints(500, 3);
  PointTree tree(points);
  TestRandom random(4);
  std::vector<Index> pieces;
  std::vector<float> reach;
  for (const Vec3f& p : points) {
    pieces.push_back(p.x() < 0.5f ? 0 : random.below(4));
    reach.push_back(static_cast<float>(0.02 * random.unit() * random.unit()));
  }
  tree.setPieces(pieces);
  const std::vector<float> partReach = tree.largestOf(reach);
  std::set<VertexPair> found;
  tree.forNearPairs([&](PointTree::Part part) { return partReach[part]; },
                    [&](Index a, Index b, float distanceSquared) {
                      EXPECT_NE(pieces[a], pieces[b]);
                      EXPECT_EQ(distanceSquared, (points[a] - points[b]).squaredNorm());
                      EXPECT_TRUE(found.insert({std::min(a, b), std::max(a, b)}).second) << a << " " << b;
                    });
  for (Index a = 0; a < points.size(); ++a) {
    for (Index b = a + 1; b < points.size(); ++b) {
      if (pieces[a] == pieces[b] || (points[a] - points[b]).squaredNorm() > std::max(reach[a], reach[b])) continue;
      EXPECT_EQ(found.count({a, b}), 1u) << a << " " << b;
    }
  }
  EXPECT_LT(found.size(), points.size() * points.size() / 20);  // and hardly any others
}

TEST(MortonOrder, VisitsEveryPointOnceAndKeepsNeighborsTogether) {
  const std::vector<Vec3f> points = randomPoints(4000, 6);
  std::vector<Index> order = mortonOrder(points);
  double along = 0, asGiven = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    along += (points[order[i]] - points[order[i - 1]]).norm();
    asGiven += (points[i] - points[i - 1]).norm();
  }
  EXPECT_LT(along, 0.25 * asGiven);
  std::sort(order.begin(), order.end());
  for (Index i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST(PointTree, FindsTheNearestPointThatIsLeft) {
  std::vector<Vec3f> points = randomPoints(3000, 5);
  points.push_back({0, 1e7f, 0});  // beside it all others lie in one cell
  PointTree tree(points);
  std::vector<bool> isOut(points.size(), false);
  for (const Vec3f& p : randomPoints(300, 6)) {
    constexpr float kRadius = 0.06f;
    Index nearest = kNoIndex;
    float least = kRadius * kRadius;
    for (Index i = 0; i < points.size(); ++i) {
      const float distance = (points[i] - p).squaredNorm();
      if (isOut[i] || distance > least || (distance == least && nearest != kNoIndex)) continue;
      nearest = i;
      least = distance;
    }
    ASSERT_EQ(tree.nearest(p, kRadius), nearest);
    if (nearest == kNoIndex) continue;
    tree.takeOut(nearest);
    isOut[nearest] = true;
  }
  EXPECT_EQ(PointTree({}).nearest({0, 0, 0}, 1), kNoIndex);
}

TEST(MortonOrder, WhatCrowdsInOneCellIsOrderedToo) {
  std::vector<Vec3f> points = randomPoints(2000, 7);
  const std::vector<Index> alone = mortonOrder(points);
  points.push_back({0, 1e7f, 0});
  const std::vector<Index> order = mortonOrder(points);
  ASSERT_EQ(order.back(), 2000u);
  EXPECT_EQ(std::vector<Index>(order.begin(), order.end() - 1), alone);
  EXPECT_EQ(mortonOrder(std::vector<Vec3f>(1000, Vec3f::Ones()))[999], 999u);
}

}  // namespace

}  // namespace limber
