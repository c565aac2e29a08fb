#include "limber/actions/parts/max_flow.h"

#include <algorithm>
#include <tuple>

namespace limber {

void MaxFlow::addEdge(Index a, Index b, double forward, double backward) {
  for (const auto& [from, to, room] : {std::tuple{a, b, forward}, std::tuple{b, a, backward}}) {
    arcs_.push_back({to, firstArc_[from], room});
    firstArc_[from] = static_cast<Index>(arcs_.size() - 1);
  }
}

bool MaxFlow::findLevels(Index source, Index sink) {
  level_.assign(firstArc_.size(), kNoIndex);
  std::vector<Index> queue = {source};
  level_[source] = 0;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const Index node = queue[head];
    for (Index a = firstArc_[node]; a != kNoIndex; a = arcs_[a].next) {
      if (arcs_[a].room <= 0 || level_[arcs_[a].to] != kNoIndex) continue;
      level_[arcs_[a].to] = level_[node] + 1;
      queue.push_back(arcs_[a].to);
    }
  }
  return level_[sink] != kNoIndex;
}

// Walks forward along the levels, each time on from where the last path was full; a dead end is never entered again.
double MaxFlow::blockingFlow(Index source, Index sink) {
  double flow = 0;
  currentArc_ = firstArc_;
  std::vector<Index> path;  // arcs from the source
  for (Index node = source;;) {
    if (node == sink) {
      double room = arcs_[path.front()].room;
      for (const Index a : path) room = std::min(room, arcs_[a].room);
      std::size_t full = path.size();
      for (std::size_t i = path.size(); i-- > 0;) {
        arcs_[path[i]].room -= room;
        arcs_[path[i] ^ 1].room += room;
        if (arcs_[path[i]].room <= 0) full = i;
      }
      flow += room;
      node = arcs_[path[full] ^ 1].to;
      path.resize(full);
      continue;
    }
    Index& a = currentArc_[node];
    while (a != kNoIndex && (arcs_[a].room <= 0 || level_[arcs_[a].to] != level_[node] + 1)) a = arcs_[a].next;
    if (a != kNoIndex) {
      path.push_back(a);
      node = arcs_[a].to;
    } else if (path.empty()) {
      return flow;
    } else {
      node = arcs_[path.back() ^ 1].to;
      path.pop_back();
      currentArc_[node] = arcs_[currentArc_[node]].next;
    }
  }
}

double MaxFlow::run(Index source, Index sink, const std::function<void()>& heartbeat) {
  double flow = 0;
  while (findLevels(source, sink)) {
    if (heartbeat) heartbeat();
    flow += blockingFlow(source, sink);
  }
  return flow;
}

}  // namespace limber
