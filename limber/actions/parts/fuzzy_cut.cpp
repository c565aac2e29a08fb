#include "limber/actions/parts/fuzzy_cut.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>

#include "limber/actions/parts/max_flow.h"
#include "limber/core/disjoint_sets.h"

namespace limber {

namespace {

constexpr double kIslandFraction = 0.1;  // of a part's area
constexpr int kIslandRounds = 8;

using PartPair = std::array<Index, 2>;  // first < second

// Redistributes the fuzzy triangles between two parts.
class PairCut {
 public:
  PairCut(const FaceGraph& graph, const PartPair& parts, std::vector<Index>& partOf, std::vector<Index>& nodeOf)
      : graph_(graph), parts_(parts), partOf_(partOf), nodeOf_(nodeOf) {}

  void run(std::span<const Index> region, const std::function<void()>& heartbeat) {
    const auto count = static_cast<Index>(region.size());
    for (Index n = 0; n < count; ++n) nodeOf_[region[n]] = n;
    MaxFlow flow(count + 2);
    touches_[0].assign(count, false);
    touches_[1].assign(count, false);
    DisjointSets patches(count);
    for (Index n = 0; n < count; ++n) addNode(n, region[n], count, flow, patches);
    flow.run(count, count + 1, heartbeat);
    for (Index n = 0; n < count; ++n) {
      for (std::vector<bool>& touches : touches_) {
        if (touches[n]) touches[patches.find(n)] = true;
      }
    }
    for (Index n = 0; n < count; ++n) {
      const Index patch = patches.find(n);
      if (!touches_[0][patch] || !touches_[1][patch]) continue;
      partOf_[region[n]] = parts_[flow.onSourceSide(n) ? 0 : 1];
    }
    for (const Index face : region) nodeOf_[face] = kNoIndex;
  }

 private:
  void addNode(Index node, Index face, Index source, MaxFlow& flow, DisjointSets& patches) {
    for (const Index a : graph_.arcsAt.of(face)) {
      const FaceArc& arc = graph_.arcs[a];
      if (arc.isLink) continue;
      const Index other = graph_.across(a, face);
      if (nodeOf_[other] != kNoIndex) {
        if (nodeOf_[other] < node) continue;  // comes from there
        flow.addEdge(node, nodeOf_[other], arc.capacity, arc.capacity);
        patches.unite(node, nodeOf_[other]);
        continue;
      }
      for (const Index side : {0u, 1u}) {
        if (partOf_[other] != parts_[side]) continue;
        touches_[side][node] = true;
        if (side == 0) flow.addEdge(source, node, arc.capacity, 0);
        if (side == 1) flow.addEdge(node, source + 1, arc.capacity, 0);
      }
    }
  }

  const FaceGraph& graph_;
  PartPair parts_;
  std::vector<Index>&partOf_, &nodeOf_;
  std::vector<bool> touches_[2];  // #nodes: lies beside a triangle that is surely of that part
};

// Connected patches of equal parts, over shared edges alone.
struct Patches {
  std::vector<Index> patchOf;  // #F: its lowest triangle
  std::vector<double> areas;   // #F, at those triangles
};

Patches findPatches(const FaceGraph& graph, std::span<const Index> partOf) {
  DisjointSets sets(graph.faceCount());
  for (const FaceArc& arc : graph.arcs) {
    if (!arc.isLink && partOf[arc.a] == partOf[arc.b]) sets.unite(arc.a, arc.b);
  }
  Patches patches{std::vector<Index>(graph.faceCount()), std::vector<double>(graph.faceCount(), 0)};
  for (Index t = 0; t < graph.faceCount(); ++t) {
    patches.patchOf[t] = sets.find(t);
    patches.areas[patches.patchOf[t]] += graph.areas[t];
  }
  return patches;
}

// The patches that are too small to stand where they are, smallest first.
std::vector<Index> islandsOf(const Patches& patches, std::span<const Index> partOf) {
  struct PartArea {
    double all = 0, largest = -1;
    Index largestPatch = kNoIndex;
  };
  std::map<Index, PartArea> areas;
  for (Index t = 0; t < partOf.size(); ++t) {
    if (patches.patchOf[t] != t) continue;
    PartArea& area = areas[partOf[t]];
    area.all += patches.areas[t];
    if (patches.areas[t] > area.largest) {
      area.largest = patches.areas[t];
      area.largestPatch = t;
    }
  }
  std::vector<Index> islands;
  for (Index t = 0; t < partOf.size(); ++t) {
    if (patches.patchOf[t] != t) continue;
    const PartArea& area = areas[partOf[t]];
    if (t != area.largestPatch && patches.areas[t] < kIslandFraction * area.all) islands.push_back(t);
  }
  std::stable_sort(islands.begin(), islands.end(),
                   [&](Index a, Index b) { return patches.areas[a] < patches.areas[b]; });
  return islands;
}

// Of the parts round a patch the one with the longest boundary; none where it is a whole piece.
std::optional<Index> partRound(const FaceGraph& graph, std::span<const Index> faces, std::span<const Index> partOf) {
  std::map<Index, double> boundary;
  for (const Index face : faces) {
    for (const Index a : graph.arcsAt.of(face)) {
      const Index other = graph.across(a, face);
      if (!graph.arcs[a].isLink && partOf[other] != partOf[face]) boundary[partOf[other]] += graph.arcs[a].length;
    }
  }
  std::optional<Index> best;
  for (const auto& [part, length] : boundary) {
    if (!best || length > boundary[*best]) best = part;
  }
  return best;
}

}  // namespace

std::vector<Index> cutFuzzyParts(const FaceGraph& graph, const FuzzyParts& fuzzy, double fuzziness,
                                 Progress& progress) {
  std::vector<Index> partOf = fuzzy.first;
  std::map<PartPair, std::vector<Index>> regions;
  for (Index t = 0; t < graph.faceCount(); ++t) {
    if (static_cast<double>(fuzzy.lead[t]) < fuzziness && fuzzy.first[t] != fuzzy.second[t]) {
      const auto [low, high] = std::minmax(fuzzy.first[t], fuzzy.second[t]);
      regions[{low, high}].push_back(t);
    }
  }
  std::vector<Index> nodeOf(graph.faceCount(), kNoIndex);
  std::size_t cuts = 0;
  for (const auto& [pair, region] : regions) {
    const double fraction = static_cast<double>(cuts++) / static_cast<double>(regions.size());
    PairCut(graph, pair, partOf, nodeOf).run(region, [&] { progress.update(fraction); });
  }
  return partOf;
}

void mergeIslands(const FaceGraph& graph, std::vector<Index>& partOf, Progress& progress) {
  for (int round = 0; round < kIslandRounds; ++round) {
    progress.update(static_cast<double>(round) / kIslandRounds);
    const Patches patches = findPatches(graph, partOf);
    const Grouped<Index> facesOf = numbersByGroup(patches.patchOf, graph.faceCount());
    bool changed = false;
    for (const Index island : islandsOf(patches, partOf)) {
      const std::optional<Index> part = partRound(graph, facesOf.of(island), partOf);
      if (!part) continue;
      for (const Index face : facesOf.of(island)) partOf[face] = *part;
      changed = true;
    }
    if (!changed) return;
  }
}

}  // namespace limber
