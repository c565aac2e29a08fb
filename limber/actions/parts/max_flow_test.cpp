#include "limber/actions/parts/max_flow.h"

#include <gtest/gtest.h>

#include "limber/core/random.h"

namespace limber {
namespace {

struct Edge {
  Index a = 0, b = 0;
  double forward = 0, backward = 0;
};

// What leaves the nodes of `side` (bits), for every set of nodes with the source and without the sink: the least.
double smallestCut(Index nodes, const std::vector<Edge>& edges, Index source, Index sink) {
  double least = 1e300;
  for (unsigned side = 0; side < (1u << nodes); ++side) {
    if (!(side >> source & 1) || (side >> sink & 1)) continue;
    double cut = 0;
    for (const Edge& e : edges) {
      const bool a = side >> e.a & 1, b = side >> e.b & 1;
      if (a && !b) cut += e.forward;
      if (b && !a) cut += e.backward;
    }
    least = std::min(least, cut);
  }
  return least;
}

TEST(MaxFlow, IsTheSmallestOfAllCuts) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto nodes = static_cast<Index>(2 + random.below(8));
    std::vector<Edge> edges;
    const std::size_t count = random.below(25);
    MaxFlow flow(nodes);
    for (std::size_t e = 0; e < count; ++e) {
      Edge edge;
      edge.a = static_cast<Index>(random.below(nodes));
      edge.b = static_cast<Index>(random.below(nodes));
      edge.forward = random.below(4) == 0 ? 0 : random.uniform(0, 3);
      edge.backward = random.below(2) == 0 ? edge.forward : 0;
      if (edge.a == edge.b) continue;
      edges.push_back(edge);
      flow.addEdge(edge.a, edge.b, edge.forward, edge.backward);
    }
    const double value = flow.run(0, 1);
    EXPECT_NEAR(value, smallestCut(nodes, edges, 0, 1), 1e-12) << trial;
    double cut = 0;
    for (const Edge& e : edges) {
      if (flow.onSourceSide(e.a) && !flow.onSourceSide(e.b)) cut += e.forward;
      if (flow.onSourceSide(e.b) && !flow.onSourceSide(e.a)) cut += e.backward;
    }
    EXPECT_NEAR(cut, value, 1e-12) << trial;
    EXPECT_TRUE(flow.onSourceSide(0));
    EXPECT_FALSE(flow.onSourceSide(1));
  }
}

TEST(MaxFlow, GoesBackOnItselfWhereThatHelps) {
  MaxFlow flow(4);  // the classical diamond with a bridge that must not be used
  flow.addEdge(0, 2, 1, 0);
  flow.addEdge(0, 3, 1, 0);
  flow.addEdge(2, 3, 1, 0);
  flow.addEdge(2, 1, 1, 0);
  flow.addEdge(3, 1, 1, 0);
  EXPECT_EQ(flow.run(0, 1), 2);
}

TEST(MaxFlow, LongNetworksNeedNoDeepStack) {
  constexpr Index kNodes = 200000;
  MaxFlow flow(kNodes);
  for (Index n = 0; n + 1 < kNodes; ++n) flow.addEdge(n, n + 1, n == 777 ? 0.5 : 2, 0);
  EXPECT_EQ(flow.run(0, kNodes - 1), 0.5);
  EXPECT_TRUE(flow.onSourceSide(777));
  EXPECT_FALSE(flow.onSourceSide(778));
}

}  // namespace
}  // namespace limber
