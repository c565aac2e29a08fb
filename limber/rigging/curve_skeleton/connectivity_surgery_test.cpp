#include "limber/rigging/curve_skeleton/connectivity_surgery.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/disjoint_sets.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

EvenSurface surfaceOf(const TriMesh& mesh, bool isMirrored = false) {
  const std::optional<MirrorPlane> plane = isMirrored ? std::optional<MirrorPlane>(MirrorPlane{}) : std::nullopt;
  return evenSurface(mesh, CollapseFrame::of(mesh, plane), isMirrored, 600);
}

std::size_t pieceCount(std::size_t nodes, const std::vector<VertexPair>& edges) {
  DisjointSets sets(nodes);
  for (const auto& [a, b] : edges) sets.unite(a, b);
  return sets.count();
}

TEST(ConnectivitySurgery, KeepsPiecesAndCoversEveryPoint) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    const EvenSurface surface = surfaceOf(mesh);
    const CurveGraph graph = curveGraph(surface, surface.points);
    ASSERT_EQ(graph.nodeOf.size(), surface.points.size());
    std::vector<char> isMet(graph.nodeCount, 0);
    for (const Index n : graph.nodeOf) {
      ASSERT_LT(n, graph.nodeCount);
      isMet[n] = 1;
    }
    EXPECT_EQ(std::count(isMet.begin(), isMet.end(), 1), graph.nodeCount);
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      EXPECT_LT(graph.edges[e][0], graph.edges[e][1]);
      if (e > 0) {
        EXPECT_LT(graph.edges[e - 1], graph.edges[e]);
      }
    }
    EXPECT_EQ(pieceCount(graph.nodeCount, graph.edges), pieceCount(surface.points.size(), surface.edges));
  }
}

// Each triangle's three points never stay three nodes that are all next to each other because of it: what is left are
// curves, so that a surface that bounds no loop becomes a tree.
TEST(ConnectivitySurgery, ASurfaceWithoutHandlesBecomesATree) {
  for (const TriMesh& mesh : {testing::ball(3), testing::blockBiped(1), testing::flatGrid(9, 6)}) {
    const EvenSurface surface = surfaceOf(mesh);
    const CurveGraph graph = curveGraph(surface, surface.points);
    EXPECT_EQ(graph.edges.size() + 1, graph.nodeCount);
  }
}

TEST(ConnectivitySurgery, WhatIsOnThePlaneStaysOnIt) {
  const EvenSurface surface = surfaceOf(testing::blockBiped(1), true);
  const CurveGraph graph = curveGraph(surface, surface.points);
  // The nodes with points on the plane hang together without the others.
  std::vector<char> onPlane(graph.nodeCount, 0);
  for (std::size_t p = 0; p < surface.points.size(); ++p) {
    if (surface.onPlane[p]) onPlane[graph.nodeOf[p]] = 1;
  }
  std::vector<VertexPair> within;
  for (const VertexPair& edge : graph.edges) {
    if (onPlane[edge[0]] && onPlane[edge[1]]) within.push_back(edge);
  }
  const auto others = static_cast<std::size_t>(std::count(onPlane.begin(), onPlane.end(), 0));
  EXPECT_GT(others, 0u);
  EXPECT_EQ(pieceCount(graph.nodeCount, within), others + 1);
}

// A tube of points round the x axis with a node for each ring, and one wall of its last ring a node of its own.
TEST(ConnectivitySurgery, AStubWithinTheBodyIsAbsorbed) {
  EvenSurface tube;
  CurveGraph graph;
  for (Index ring = 0; ring < 6; ++ring) {
    for (int i = 0; i < 8; ++i) {
      tube.points.push_back(Vec3(2.0 * ring, std::cos(0.785398 * i), std::sin(0.785398 * i)));
      graph.nodeOf.push_back(ring == 3 && i < 2 ? 6 : ring);
    }
  }
  tube.areas.assign(tube.points.size(), 1);
  tube.onPlane.assign(tube.points.size(), 0);
  graph.nodeCount = 7;
  graph.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {3, 6}, {4, 5}};
  CurveGraph kept = graph;
  absorbStubs(tube, graph);
  EXPECT_EQ(graph.nodeCount, 6u);
  EXPECT_EQ(graph.edges, (std::vector<VertexPair>{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}));
  EXPECT_LT((nodePlacements(tube, graph)[3].point - Vec3(6, 0, 0)).norm(), 1e-6);
  // The same wall far out is a limb.
  for (const Index p : {24u, 25u}) tube.points[p] += Vec3(0, 4, 0);
  absorbStubs(tube, kept);
  EXPECT_EQ(kept.nodeCount, 7u);
}

TEST(ConnectivitySurgery, EdgesWithoutTrianglesStay) {
  EvenSurface chain;
  for (int i = 0; i < 5; ++i) chain.points.push_back(Vec3(i, 0, 0));
  chain.areas.assign(5, 1);
  chain.onPlane.assign(5, 0);
  chain.edges = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  const CurveGraph graph = curveGraph(chain, chain.points);
  EXPECT_EQ(graph.nodeCount, 5u);
  EXPECT_EQ(graph.edges, chain.edges);
}

}  // namespace

}  // namespace limber
