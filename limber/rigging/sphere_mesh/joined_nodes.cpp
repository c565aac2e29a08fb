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

// Each once, between other clusters or from one to its own image.
std::vector<GraphEdge> edgesBetween(const std::vector<GraphEdge>& edges, const std::vector<Index>& clusters) {
  std::vector<GraphEdge> result;
  for (const GraphEdge& e : edges) {
    Index a = clusters[e.from], b = clusters[nodeOf(e.to)];
    if (a == b && !crossesOf(e.to)) continue;
    if (a > b) std::swap(a, b);
    result.push_back({a, makeEnd(b, crossesOf(e.to))});
  }
  const auto key = [](const GraphEdge& e) { return std::pair(e.from, e.to); };
  std::sort(result.begin(), result.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
  result.erase(
      std::unique(result.begin(), result.end(), [&](const auto& a, const auto& b) { return key(a) == key(b); }),
      result.end());
  return result;
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
  joined.input.edges = edgesBetween(start.input.edges, clusters);
  joined.vertexEnds = std::move(start.vertexEnds);
  for (EdgeEnd& end : joined.vertexEnds) end = makeEnd(clusters[nodeOf(end)], crossesOf(end));
  joined.loose = std::move(start.loose);
  for (LooseVertex& loose : joined.loose) loose.node = clusters[loose.node];
  return joined;
}

}  // namespace limber
