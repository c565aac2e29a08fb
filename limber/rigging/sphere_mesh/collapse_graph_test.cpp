#include "limber/rigging/sphere_mesh/collapse_graph.h"

#include <map>
#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/monotone_queue.h"

namespace limber {

namespace {

using testing::TestRandom;

// Spheres one by one: node n's sphere is 2n, its image 2n + 1 (a single node has only the former). Edges are sets of
// two groups of spheres that have merged.
class PlainGraph {
 public:
  PlainGraph(const std::vector<GraphEdge>& edges, const std::vector<std::uint8_t>& single) : single_(single) {
    for (const GraphEdge& e : edges) {
      add(sphere(e.from, false), sphere(nodeOf(e.to), crossesOf(e.to)));
      add(sphere(e.from, true), sphere(nodeOf(e.to), !crossesOf(e.to)));
    }
  }

  void merge(const GraphEdge& e, Index kept) {
    const Index gone = e.from == kept ? nodeOf(e.to) : e.from;
    const bool toSingle = gone == kept || single_[kept] || single_[gone];
    std::map<Index, Index> to;
    to[sphere(gone, false)] = toSingle ? 2 * kept : 2 * kept + crossesOf(e.to);
    to[sphere(gone, true)] = toSingle ? 2 * kept : 2 * kept + !crossesOf(e.to);
    if (toSingle) to[2 * kept + 1] = 2 * kept;
    single_[kept] = toSingle;
    std::set<std::pair<Index, Index>> old;
    old.swap(edges_);
    for (auto [a, b] : old) add(to.count(a) ? to[a] : a, to.count(b) ? to[b] : b);
  }

  const std::set<std::pair<Index, Index>>& edges() const { return edges_; }

  Index sphere(Index node, bool image) const { return 2 * node + (image && !single_[node] ? 1 : 0); }

 private:
  void add(Index a, Index b) {
    if (a != b) edges_.insert({std::min(a, b), std::max(a, b)});
  }

  std::vector<std::uint8_t> single_;
  std::set<std::pair<Index, Index>> edges_;
};

std::set<std::pair<Index, Index>> expanded(const CollapseGraph& graph, Index edgeCount) {
  std::set<std::pair<Index, Index>> edges;
  const auto sphere = [&](Index node, bool image) { return 2 * node + (image && !graph.single(node) ? 1u : 0u); };
  for (Index e = 0; e < edgeCount; ++e) {
    if (!graph.alive(e)) continue;
    const Index from = graph.edge(e).from;
    const EdgeEnd to = graph.edge(e).to;
    for (const bool image : {false, true}) {
      const Index a = sphere(from, image), b = sphere(nodeOf(to), crossesOf(to) != image);
      EXPECT_NE(a, b);
      edges.insert({std::min(a, b), std::max(a, b)});
    }
  }
  return edges;
}

struct Case {
  std::vector<GraphEdge> edges;
  std::vector<std::uint8_t> single;
};

// `hubs` nodes are next to nearly everything.
Case randomCase(Index nodes, Index edgeCount, Index hubs, double singles, std::uint64_t seed) {
  TestRandom random(seed);
  Case result;
  for (Index i = 0; i < nodes; ++i) result.single.push_back(random.unit() < singles);
  std::set<std::pair<Index, EdgeEnd>> seen;
  const auto add = [&](Index a, Index b, bool crosses) {
    if (result.single[a] || result.single[b]) crosses = false;
    if (a == b && (result.single[a] || !crosses)) return;
    if (a > b) std::swap(a, b);
    if (seen.insert({a, makeEnd(b, crosses)}).second) result.edges.push_back({a, makeEnd(b, crosses)});
  };
  for (Index i = 0; i < edgeCount; ++i) add(random.below(nodes), random.below(nodes), random.unit() < 0.3);
  for (Index hub = 0; hub < hubs; ++hub) {
    for (Index i = 0; i < nodes; ++i) add(hub, i, random.unit() < 0.3);
  }
  return result;
}

void collapseRandomly(const Case& start, std::uint64_t seed) {
  CollapseGraph graph(start.edges, {}, start.single);
  PlainGraph plain(start.edges, start.single);
  const Index count = static_cast<Index>(start.edges.size());
  TestRandom random(seed);
  std::vector<float> keys;
  for (Index e = 0; e < count; ++e) keys.push_back(static_cast<float>(random.below(1000)));
  MonotoneQueue heap;
  heap.fill(keys);
  Index died = 0;
  while (!heap.empty()) {
    const Index e = heap.top();
    const GraphEdge ends = graph.edge(e);
    const Index a = ends.from, b = nodeOf(ends.to);
    const Index kept =
        graph.linkCount(b) > graph.linkCount(a) || (random.unit() < 0.3 && graph.linkCount(a) < 40) ? b : a;
    plain.merge(ends, kept);
    graph.merge(e, kept, heap);
    for (const DeadEdge& dead : graph.dead()) {
      ASSERT_FALSE(graph.alive(dead.edge));
      heap.remove(dead.edge);
      ++died;
    }
    for (const Index touched : graph.touched()) {
      ASSERT_TRUE(!graph.alive(touched) || heap.contains(touched));
    }
    ASSERT_EQ(expanded(graph, count), plain.edges());
    // No two edges have the same ends and crossing, and none is missing from the heap.
    std::size_t alive = 0;
    std::set<std::pair<Index, EdgeEnd>> neighbours;
    for (Index i = 0; i < count; ++i) {
      ASSERT_EQ(graph.alive(i), heap.contains(i));
      if (!graph.alive(i)) continue;
      ++alive;
      const Index from = graph.edge(i).from;
      const EdgeEnd to = graph.edge(i).to;
      neighbours.insert({std::min(from, nodeOf(to)), makeEnd(std::max(from, nodeOf(to)), crossesOf(to))});
    }
    ASSERT_EQ(neighbours.size(), alive);
  }
  EXPECT_EQ(died, count);
}

TEST(CollapseGraph, ContractsAsAPlainGraphOfSets) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) collapseRandomly(randomCase(40, 90, 0, 1, seed), seed);
}

TEST(CollapseGraph, ContractsPairsTogetherWithTheirImages) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) collapseRandomly(randomCase(40, 90, 0, 0.2, seed), seed);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) collapseRandomly(randomCase(30, 60, 0, 0, seed), seed);
}

TEST(CollapseGraph, ContractsNodesOfManyLinks) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    collapseRandomly(randomCase(150, 100, 3, 1, seed), seed);
    collapseRandomly(randomCase(150, 100, 3, 0.3, seed), seed);
    collapseRandomly(randomCase(120, 100, 2, 0, seed), seed);
  }
}

// Hubs that share their neighbours lose most of their links to each other, and become plain nodes again.
TEST(CollapseGraph, ContractsHubsThatShrink) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    collapseRandomly(randomCase(70, 40, 12, 1, seed), seed);
    collapseRandomly(randomCase(70, 40, 12, 0.3, seed), seed);
    collapseRandomly(randomCase(70, 40, 12, 0, seed), seed);
  }
}

TEST(CollapseGraph, OfEdgesThatBecomeOneTheGreaterKeyStays) {
  const std::vector<GraphEdge> triangle = {{0, makeEnd(1, false)}, {1, makeEnd(2, false)}, {0, makeEnd(2, false)}};
  CollapseGraph graph(triangle, std::vector<Border>{7, 20, 300}, {1, 1, 1});
  MonotoneQueue heap;
  heap.fill({1, 5, 3});
  graph.merge(0, 0, heap);
  EXPECT_TRUE(graph.alive(1));
  EXPECT_FALSE(graph.alive(2));
  ASSERT_EQ(graph.dead().size(), 2u);
  EXPECT_EQ(graph.dead()[0].joined, kNoIndex);  // between the two that are one now
  EXPECT_EQ(graph.dead()[1].joined, 1u);
  EXPECT_EQ(graph.dead()[1].border, 300u);
  EXPECT_EQ(graph.edge(1).border, 320u);
}

}  // namespace

}  // namespace limber
