// Shortest paths over a graph of any form.
#pragma once

#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace limber {

// Dijkstra's algorithm: makes `distances` (#nodes) the shortest that lead on from the sources, whose own are set,
// wherever that is less than what is there.
//
// forEachNeighbour  (node, visit), calls visit(neighbour, length) for each neighbour, lengths 0 or more
// reach             (from, to), called each time that a node is reached on a shorter path
// Cost: O(n log n) in the nodes reached, with a few neighbours each.
template <typename Node, typename Distance, typename ForEachNeighbour, typename Reach>
void shortenPaths(std::span<const Node> sources, std::vector<Distance>& distances,
                  const ForEachNeighbour& forEachNeighbour, const Reach& reach) {
  using Entry = std::pair<Distance, Node>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const Node node : sources) queue.emplace(distances[node], node);
  while (!queue.empty()) {
    const Distance distance = queue.top().first;
    const Node at = queue.top().second;
    queue.pop();
    if (distance > distances[at]) continue;
    forEachNeighbour(at, [&](Node next, Distance length) {
      const Distance further = distance + length;
      if (!(further < distances[next])) return;
      distances[next] = further;
      reach(at, next);
      queue.emplace(further, next);
    });
  }
}

}  // namespace limber
