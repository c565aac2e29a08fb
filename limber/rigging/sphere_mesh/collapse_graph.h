// What is next to what while spheres are merged: a graph under edge contraction, in flat memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

class MonotoneQueue;

// Nodes represent one sphere on the mirror plane ("single"), or a sphere and its mirror image ("pair"); without
// symmetry all are single. An edge between pairs joins sphere to sphere and image to image, or, when it crosses, each
// to the image of the other. An edge from a pair to itself joins a sphere to its own image and always crosses. An end
// of an edge packs node and crossing as 2 * node + crosses.
using EdgeEnd = std::uint32_t;
inline constexpr Index kMaxNodes = Index{1} << 31;
inline constexpr EdgeEnd makeEnd(Index node, bool crosses) {
  return node << 1 | static_cast<EdgeEnd>(crosses);
}
inline constexpr Index nodeOf(EdgeEnd end) {
  return end >> 1;
}
inline constexpr bool crossesOf(EdgeEnd end) {
  return (end & 1) != 0;
}

struct GraphEdge {
  Index from = 0;
  EdgeEnd to = 0;
};

// The length of the border between what two neighbours represent, on each side of the mirror plane, in 2^-20 of the
// model's longest side: whole numbers, so that sums are exact in any order.
using Border = std::uint32_t;
inline constexpr double kBorderUnit = 0x1p-20;

// An edge that is no more: between nodes that merged, or because it became one with another edge.
struct DeadEdge {
  Index edge = 0;
  Index joined = kNoIndex;  // the edge that it became one with, whose border has grown by its own
  Border border = 0;        // when it went
};

// Between two nodes at most one edge that crosses is kept, and one that does not. Neighbours are blocks of links in one
// pool; block sizes are powers of two, and freed blocks are used again. Blocks of more than kHub links are not kept up
// to date when a neighbour merges, which would cost their length each time: their links are read through the edge
// itself, and dead ones are dropped when the block is next rewritten. A merge costs O(links of the node with fewer).
class CollapseGraph {
 public:
  // edges    no duplicates; an edge to a single node does not cross
  // borders  per edge, or empty: none has any
  CollapseGraph(std::span<const GraphEdge> edges, std::span<const Border> borders, std::vector<std::uint8_t> single);

  // With a number of the caller's that goes with each edge, at first 0.
  struct Edge : GraphEdge {
    Border border = 0;
    Index note = 0;
  };
  const Edge& edge(Index e) const { return edges_[e]; }
  void setNote(Index e, Index note) { edges_[e].note = note; }
  bool alive(Index e) const { return edges_[e].from != kNoIndex; }
  bool single(Index node) const { return single_[node] != 0; }
  Index linkCount(Index node) const { return blocks_[node].size; }

  // Merges the ends of e into `kept`, one of them. The result is single unless both were pairs. Of edges that become
  // one the edge with the greater key stays.
  void merge(Index e, Index kept, const MonotoneQueue& keys);

  // After merge(): the edges that are no more, e first; and living edges that have a new end or joined a single node.
  std::span<const DeadEdge> dead() const { return dead_; }
  std::span<const Index> touched() const { return touched_; }

 private:
  struct Link {
    EdgeEnd to = 0;
    Index edge = 0;
  };
  struct Block {
    std::size_t begin = 0;
    Index size = 0;
    std::uint8_t sizeClass = 0;
  };
  struct Mark {
    Index time = 0;
    Index slot = 0;
  };
  // What a merge is about; set by merge().
  struct Operation {
    Index edge = 0, kept = 0, gone = 0;
    bool crosses = false;      // e joined kept to the image of gone
    bool toSingle = false;     // the result is single
    bool turnsSingle = false;  // and kept was a pair before
  };
  static constexpr Index kHub = 48;
  static constexpr Index capacity(int sizeClass) { return Index{8} << sizeClass; }

  bool lazy(Index node) const { return blocks_[node].size > kHub; }
  EdgeEnd otherEnd(Index e, Index node) const {
    const Edge& g = edges_[e];
    return nodeOf(g.to) == node ? makeEnd(g.from, crossesOf(g.to)) : g.to;
  }
  Link* links(Index node) { return pool_.data() + blocks_[node].begin; }

  void mergeByMarks();
  void mergeIntoHub();
  void gather(Index source);
  Index* find(EdgeEnd to);
  void keep(Link link);
  void joinHub(Index e, EdgeEnd to);
  // Where a link of kept or gone to `to` leads after the merge.
  EdgeEnd retarget(EdgeEnd to, bool fromGone) const;
  bool inside(Index node) const { return node == operation_.kept || node == operation_.gone; }
  void kill(Index e, Index joined = kNoIndex);

  Block allocate(Index size);
  void release(const Block& block) { free_[block.sizeClass].push_back(block.begin); }
  void append(Index node, Link link);
  void compact(Index node);
  void relink(Index node, Index e, EdgeEnd to);
  void unlink(Index node, Index e);
  Index findEdge(Index a, EdgeEnd to);

  std::vector<Edge> edges_;
  std::vector<std::uint8_t> single_;  // per node
  std::vector<Block> blocks_;         // per node
  std::vector<Link> pool_;
  std::vector<std::size_t> free_[32];  // per size class: begins of blocks

  Operation operation_;
  const MonotoneQueue* keys_ = nullptr;
  std::vector<Link> merged_;
  bool marking_ = false;     // in this merge
  std::vector<Mark> marks_;  // per edge end: merge number `time` met it as merged_[slot]
  Index time_ = 0;
  std::vector<DeadEdge> dead_;
  std::vector<Index> touched_;
};

}  // namespace limber
