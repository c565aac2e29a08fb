// The largest flow between two nodes of a network, and the smallest cut that stops it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Dinic 1970: breadth first levels, then a blocking flow along them, until the sink is out of reach. The same calls in
// the same order give the same flow, bit for bit. Cost: O(#nodes^2 #edges) at worst; some tens of passes over the edges
// on surfaces.
class MaxFlow {
 public:
  explicit MaxFlow(Index nodeCount) : firstArc_(nodeCount, kNoIndex) {}

  // What may flow from a to b and from b to a: 0 or more, finite.
  void addEdge(Index a, Index b, double forward, double backward);

  // The largest flow; once for each network. source != sink. `heartbeat`, if any, is called before each pass over the
  // edges, and may throw.
  double run(Index source, Index sink, const std::function<void()>& heartbeat = {});

  // After run(): can the node still be reached from the source? The edges that leave the nodes for which this holds are
  // a smallest cut, of all such the one nearest to the source.
  bool onSourceSide(Index node) const { return level_[node] != kNoIndex; }

 private:
  struct Arc {
    Index to = 0;
    Index next = kNoIndex;  // of the same node
    double room = 0;        // residual capacity; arc i ^ 1 is the reverse
  };

  bool findLevels(Index source, Index sink);
  double blockingFlow(Index source, Index sink);

  std::vector<Arc> arcs_;
  std::vector<Index> firstArc_, currentArc_, level_;  // #nodes
};

}  // namespace limber
