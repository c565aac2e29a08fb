#include "limber/rigging/sphere_mesh/joined_nodes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limber/core/disjoint_sets.h"

namespace limber {

namespace {

constexpr int kFinest = 10;  // halvings of a unit, at first

using Cell = std::array<int, 3>;

std::vector<Cell> finestCells(const std::vector<Vec3f>& centers) {
  std::vector<Cell> cells;
  cells.reserve(centers.size());
  for (const Vec3f& center : centers) {
    Cell& cell = cells.emplace_back();
    for (int axis = 0; axis < 3; ++axis) cell[axis] = static_cast<int>(std::floor(std::ldexp(center[axis], kFinest)));
  }
  return cells;
}

bool areInOneCell(const Cell& a, const Cell& b, int halvings) {
  const int shift = kFinest - halvings;
  return a[0] >> shift == b[0] >> shift && a[1] >> shift == b[1] >> shift && a[2] >> shift == b[2] >> shift;
}

// The new number of each node: clusters in the order of their lowest nodes.
std::vector<Index> clustersOf(const CollapseStart& start, Index maxNodes, Index& count) {
  const std::vector<std::uint8_t>& single = start.input.single;
  const std::vector<Cell> cells = finestCells(start.nodeCenters);
  DisjointSets sets(single.size());
  // Cells of a coarser grid are made of those of a finer one.
  for (int halvings = kFinest; halvings >= 0 && sets.count() > maxNodes; --halvings) {
    for (const GraphEdge& e : start.input.edges) {
      const Index to = nodeOf(e.to);
      if (crossesOf(e.to) || single[e.from] != single[to]) continue;
      if (areInOneCell(cells[e.from], cells[to], halvings)) sets.unite(e.from, to);
    }
  }
  std::vector<Index> clusters(single.size());
  count = 0;
  for (Index node = 0; node < clusters.size(); ++node) {
    const Index lowest = sets.find(node);
    clusters[node] = lowest == node ? count++ : clusters[lowest];
  }
  return clusters;
}

// Each once, between other clusters or from one to its own image, with the borders of all that it is made of.
void joinEdges(const CollapseInput& input, const std::vector<Index>& clusters, CollapseInput& joined) {
  struct Edge : GraphEdge {
    Border border = 0;
  };
  std::vector<Edge> edges;
  for (std::size_t e = 0; e < input.edges.size(); ++e) {
    const GraphEdge& edge = input.edges[e];
    Index a = clusters[edge.from], b = clusters[nodeOf(edge.to)];
    if (a == b && !crossesOf(edge.to)) continue;
    if (a > b) std::swap(a, b);
    edges.push_back({{a, makeEnd(b, crossesOf(edge.to))}, input.borders.empty() ? 0 : input.borders[e]});
  }
  const auto key = [](const GraphEdge& e) { return std::pair(e.from, e.to); };
  std::sort(edges.begin(), edges.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  for (const Edge& edge : edges) {
    if (joined.edges.empty() || key(joined.edges.back()) != key(edge)) {
      joined.edges.push_back(edge);
      joined.borders.push_back(0);
    }
    joined.borders.back() += edge.border;
  }
}

}  // namespace

CollapseStart joinNearNodes(CollapseStart start, Index maxNodes) {
  if (start.nodeCenters.size() <= maxNodes) return start;
  Index count = 0;
  const std::vector<Index> clusters = clustersOf(start, maxNodes, count);
  CollapseStart joined;
  joined.input.quadrics.resize(count);
  joined.input.moments.resize(count);
  joined.input.single.resize(count);
  joined.input.area = start.input.area;
  std::vector<Vec3> sums(count, Vec3::Zero());
  std::vector<Index> sizes(count, 0);
  for (std::size_t node = 0; node < clusters.size(); ++node) {
    const Index cluster = clusters[node];
    joined.input.quadrics[cluster] += start.input.quadrics[node];
    joined.input.moments[cluster] += start.input.moments[node];
    joined.input.single[cluster] = start.input.single[node];
    sums[cluster] += start.nodeCenters[node].cast<double>();
    ++sizes[cluster];
  }
  for (Index cluster = 0; cluster < count; ++cluster) {
    joined.nodeCenters.push_back((sums[cluster] / sizes[cluster]).cast<float>());
  }
  joinEdges(start.input, clusters, joined.input);
  joined.vertexEnds = std::move(start.vertexEnds);
  for (EdgeEnd& end : joined.vertexEnds) end = makeEnd(clusters[nodeOf(end)], crossesOf(end));
  joined.loose = std::move(start.loose);
  for (LooseVertex& loose : joined.loose) loose.node = clusters[loose.node];
  return joined;
}

}  // namespace limber
