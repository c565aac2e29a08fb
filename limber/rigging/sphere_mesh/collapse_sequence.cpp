// Tried and given up: an indexed heap of four or eight children instead of the radix heap (20,000 vertices, one thread,
// two cores, best of ten: 0.042 s against 0.032 s, two smaller changes included); a pull towards the points of 0.01 or
// more (SphereQuadric::kCentering), which draws handles out to the skin, and of 0.0001 or less, which lets spheres of
// flat parts grow out of the model. Edges are evaluated 3.75 times a merge on a smooth closed surface; evaluating all
// edges of the merged node would be 7 times.
#include "limber/rigging/sphere_mesh/collapse_sequence.h"

#include <algorithm>

#include "limber/core/parallel.h"
#include "limber/rigging/sphere_mesh/edge_heap.h"
#include "limber/rigging/sphere_mesh/limb_ends.h"
#include "limber/rigging/sphere_mesh/monotone_queue.h"

namespace limber {

namespace {

// What a node represents, in two cache lines.
struct alignas(64) Cluster {
  SphereQuadric quadric;  // of the sphere on the plane, or of the one of a pair on the positive side
  Index changed = 0;      // merges done when it last became what it is
  Index size = 1;         // nodes merged in it
};

Sphere boundedMinimum(const SphereQuadric& quadric, const PartMoments& moments) {
  const Sphere sphere = quadric.minimum();
  const double bound = moments.radiusBound();
  return sphere.radius <= bound ? sphere : quadric.minimumOfRadius(bound);
}

class Collapser {
 public:
  Collapser(const CollapseInput& input, Progress& progress);
  CollapseSequence run();

 private:
  template <typename Sums>
  Sums joint(const Sums& a, const Sums& b, Index kept, Index gone, bool crosses) const;
  SphereQuadric jointQuadric(Index kept, Index gone, bool crosses) const {
    return joint(clusters_[kept].quadric, clusters_[gone].quadric, kept, gone, crosses);
  }
  PartMoments jointMoments(Index kept, Index gone, bool crosses) const {
    return joint(moments_[kept], moments_[gone], kept, gone, crosses);
  }
  float evaluate(Index e) const;
  bool stale(Index e) const {
    const CollapseGraph::Edge& g = graph_.edge(e);
    return g.note < std::max(clusters_[g.from].changed, clusters_[nodeOf(g.to)].changed);
  }
  void refresh(Index e);
  void findEnds();
  // What merging e makes of the ends of limbs: that of the joint, and the cost of those that are lost.
  struct JointEnd {
    Index end = kNoIndex;
    double cost = 0;
  };
  JointEnd jointEnd(Index e) const;
  void loseEnds(const Merge& m, Index end);
  void fetchClusters(Index e) const;
  // Whether merging e takes one sphere away, not two.
  bool takesOne(Index e) const {
    const GraphEdge& g = graph_.edge(e);
    return nodeOf(g.to) == g.from || (graph_.single(g.from) && graph_.single(nodeOf(g.to)));
  }

  void merge(Index e);
  Index keptOf(Index e) const;
  Index findBridge(Index next);
  Bridge bridgeWithoutEdge(Index next) const;
  Index record(const Bridge& bridge);

  Progress& progress_;
  CollapseSequence sequence_;
  std::vector<Cluster> clusters_;  // per node
  std::vector<PartMoments> moments_;
  CollapseGraph graph_;  // an edge's note: merges done when its key was last computed
  bool symmetric_ = false;
  MonotoneQueue queue_;
  EdgeHeap bridgeHeap_;        // the edges that take one sphere away; only filled with symmetry
  std::vector<Index> madeBy_;  // per node: the last merge that kept it
  Index count_ = 0;            // spheres left
  std::vector<Index> endOf_;   // per node: the end of a limb that it is of, or kNoIndex; empty until they are known
  struct End {
    double length = 0;
    double cost = 0;  // of losing it
    bool isOnPlane = false;
  };
  std::vector<End> ends_;
  double costOfEnds_ = 0, area_ = 0;  // as in CollapseInput
  Index lastBridgeEdge_ = kNoIndex;   // that the last of sequence_.bridges was made for, and when
  Index lastBridgeTime_ = 0;
};

Collapser::Collapser(const CollapseInput& input, Progress& progress)
    : progress_(progress),
      clusters_(input.quadrics.size()),
      moments_(input.moments),
      graph_(input.edges, input.borders, input.single) {
  const std::size_t nodes = clusters_.size();
  for (std::size_t node = 0; node < nodes; ++node) clusters_[node].quadric = input.quadrics[node];
  sequence_.single = input.single;
  sequence_.edges = input.edges;
  for (const std::uint8_t single : input.single) count_ += single ? 1 : 2;
  sequence_.initialCount = count_;
  symmetric_ = count_ > nodes;
  area_ = input.area;
  costOfEnds_ = input.costOfEnds;
  sequence_.merges.reserve(nodes);
  sequence_.deadEdges.reserve(input.edges.size());
  sequence_.absorbedBy.assign(nodes, kNoIndex);
  madeBy_.assign(nodes, kNoIndex);

  std::vector<float> keys(input.edges.size());
  parallelFor(keys.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) keys[e] = evaluate(static_cast<Index>(e));
  });
  queue_.fill(keys);
  bridgeHeap_.reset(static_cast<Index>(symmetric_ ? keys.size() : 0));
  if (!symmetric_) return;
  for (Index e = 0; e < keys.size(); ++e) {
    if (takesOne(e)) bridgeHeap_.insert(e, keys[e]);
  }
}

// What holds for the sphere that kept becomes: on the plane, or the one of a pair on kept's side.
template <typename Sums>
Sums Collapser::joint(const Sums& a, const Sums& b, Index kept, Index gone, bool crosses) const {
  if (kept == gone) return a.withMirrorImage();
  const bool keptSingle = graph_.single(kept), goneSingle = graph_.single(gone);
  Sums sum = keptSingle || !goneSingle ? a : a.withMirrorImage();
  if (keptSingle != goneSingle) {
    sum += keptSingle ? b.withMirrorImage() : b;
  } else {
    sum += crosses ? b.mirrored() : b;
  }
  return sum;
}

float Collapser::evaluate(Index e) const {
  const CollapseGraph::Edge& g = graph_.edge(e);
  const Index other = nodeOf(g.to);
  if (!symmetric_ || (!crossesOf(g.to) && graph_.single(g.from) == graph_.single(other))) {
    return static_cast<float>(SphereQuadric::jointMinimumError(clusters_[g.from].quadric, clusters_[other].quadric));
  }
  return static_cast<float>(jointQuadric(g.from, other, crossesOf(g.to)).minimumError());
}

void Collapser::refresh(Index e) {
  const float key = evaluate(e) + static_cast<float>(jointEnd(e).cost);
  graph_.setNote(e, static_cast<Index>(sequence_.merges.size()));
  queue_.raise(e, key);
  if (symmetric_ && bridgeHeap_.contains(e)) bridgeHeap_.update(e, queue_.key(e));
}

// The longer a limb, the more is lost with its end. Keys only grow, as the queue asks: what is lost stays lost.
void Collapser::findEnds() {
  SphereGraph graph;
  std::vector<Index> numbers(clusters_.size(), kNoIndex), nodes;
  for (Index node = 0; node < clusters_.size(); ++node) {
    if (sequence_.absorbedBy[node] != kNoIndex) continue;
    numbers[node] = static_cast<Index>(nodes.size());
    nodes.push_back(node);
    graph.centers.push_back(boundedMinimum(clusters_[node].quadric, moments_[node]).center.cast<float>());
    graph.areas.push_back(clusters_[node].quadric.weight() * area_);
    graph.single.push_back(graph_.single(node));
  }
  for (Index e = 0; e < sequence_.edges.size(); ++e) {
    if (!graph_.alive(e)) continue;
    const GraphEdge& edge = graph_.edge(e);
    graph.edges.push_back({numbers[edge.from], makeEnd(numbers[nodeOf(edge.to)], crossesOf(edge.to))});
  }
  endOf_.assign(clusters_.size(), kNoIndex);
  for (const LimbEnd& end : limbEnds(graph)) {
    for (const Index node : end.nodes) endOf_[nodes[node]] = static_cast<Index>(ends_.size());
    const double squared = end.length * end.length;
    ends_.push_back({end.length, costOfEnds_ * squared * squared, end.isOnPlane});
  }
  for (Index e = 0; e < sequence_.edges.size(); ++e) {
    if (graph_.alive(e) && jointEnd(e).cost > 0) refresh(e);
  }
}

// The joint of two ends is still that of the longer limb: an ear that goes into the head. With anything else an end is
// lost, as is one that meets its own image.
Collapser::JointEnd Collapser::jointEnd(Index e) const {
  if (ends_.empty()) return {};
  const GraphEdge& g = graph_.edge(e);
  Index longer = endOf_[g.from], other = endOf_[nodeOf(g.to)];
  const auto costOf = [&](Index end) { return end == kNoIndex ? 0 : ends_[end].cost; };
  if (longer == other) {
    if (longer == kNoIndex || !crossesOf(g.to) || ends_[longer].isOnPlane) return {longer, 0};
    return {kNoIndex, costOf(longer)};
  }
  if (longer == kNoIndex || (other != kNoIndex && costOf(longer) < costOf(other))) std::swap(longer, other);
  if (other == kNoIndex) return {kNoIndex, costOf(longer)};
  if (crossesOf(g.to) && !ends_[longer].isOnPlane) return {kNoIndex, costOf(longer) + costOf(other)};
  return {longer, costOf(other)};
}

// `end` is what the joint of a merge is of.
void Collapser::loseEnds(const Merge& m, Index end) {
  for (const Index node : {m.kept, m.gone}) {
    const Index lost = endOf_[node];
    endOf_[node] = kNoIndex;
    if (lost == kNoIndex || lost == end) continue;
    if (std::find(endOf_.begin(), endOf_.end(), lost) != endOf_.end()) continue;  // others have it still
    const Index countBefore = m.countAfter + (m.bridge == kNoIndex ? 1 : 2);
    sequence_.lostEnds.push_back({countBefore, static_cast<float>(ends_[lost].length)});
  }
  endOf_[m.kept] = end;
}

// Most of the time of a large collapse would go into waiting for these.
void Collapser::fetchClusters(Index e) const {
  if (e == kNoIndex) return;
  for (const Index node : {graph_.edge(e).from, nodeOf(graph_.edge(e).to)}) {
    const char* const cluster = reinterpret_cast<const char*>(&clusters_[node]);
    __builtin_prefetch(cluster);
    __builtin_prefetch(cluster + 64);
  }
}

CollapseSequence Collapser::run() {
  const double total = count_;
  for (std::size_t step = 0; !queue_.empty(); ++step) {
    if (step % 16384 == 0) progress_.update(1 - count_ / total);
    if (endOf_.empty() && count_ <= kEndsKnownFrom) findEnds();
    const Index e = queue_.top([this](Index soon) { __builtin_prefetch(&graph_.edge(soon)); });
    fetchClusters(queue_.next());
    if (stale(e)) {
      refresh(e);
    } else {
      merge(e);
    }
  }
  return std::move(sequence_);
}

// The node with more links; near equal ones by how much they stand for, which keeps the chains of absorption short.
Index Collapser::keptOf(Index e) const {
  const Index a = graph_.edge(e).from, b = nodeOf(graph_.edge(e).to);
  constexpr Index kMany = 32;
  const Index linksA = std::max(graph_.linkCount(a), kMany), linksB = std::max(graph_.linkCount(b), kMany);
  if (linksA != linksB) return linksA > linksB ? a : b;
  if (clusters_[a].size != clusters_[b].size) return clusters_[a].size > clusters_[b].size ? a : b;
  return std::min(a, b);
}

void Collapser::merge(Index e) {
  const Index time = static_cast<Index>(sequence_.merges.size());
  const GraphEdge ends = graph_.edge(e);
  Merge m;
  m.kept = keptOf(e);
  m.gone = m.kept == ends.from ? nodeOf(ends.to) : ends.from;
  m.crosses = crossesOf(ends.to);
  m.bridge = kNoIndex;
  if (!takesOne(e)) {
    m.bridge = findBridge(e);
    --count_;
  }
  --count_;
  m.countAfter = count_;
  m.keptBefore = madeBy_[m.kept];
  m.goneBefore = madeBy_[m.gone];
  m.deadBegin = static_cast<Index>(sequence_.deadEdges.size());
  m.error = queue_.key(e);

  if (!ends_.empty()) loseEnds(m, jointEnd(e).end);
  SphereQuadric& quadric = clusters_[m.kept].quadric;
  PartMoments& moments = moments_[m.kept];
  quadric = jointQuadric(m.kept, m.gone, m.crosses);
  moments = jointMoments(m.kept, m.gone, m.crosses);
  const Sphere sphere = boundedMinimum(quadric, moments);
  m.center = sphere.center.cast<float>();
  m.radius = static_cast<float>(sphere.radius);
  const double pull = SphereQuadric::kCentering * moments.squaredDistances(sphere.center);
  m.planeError = static_cast<float>(std::max(0.0, quadric.error(sphere) - pull));
  m.weight = static_cast<float>(quadric.weight());

  graph_.merge(e, m.kept, queue_);
  m.single = graph_.single(m.kept);
  for (const DeadEdge& dead : graph_.dead()) {
    queue_.remove(dead.edge);
    if (symmetric_ && bridgeHeap_.contains(dead.edge)) bridgeHeap_.remove(dead.edge);
    sequence_.deadEdges.push_back(dead);
  }
  if (symmetric_) {
    for (const Index touched : graph_.touched()) {
      if (graph_.alive(touched) && takesOne(touched) && !bridgeHeap_.contains(touched)) {
        bridgeHeap_.insert(touched, queue_.key(touched));
      }
    }
  }
  clusters_[m.kept].changed = time + 1;
  madeBy_[m.kept] = time;
  if (m.gone != m.kept) {
    clusters_[m.kept].size += clusters_[m.gone].size;
    sequence_.absorbedBy[m.gone] = time;
  }
  sequence_.merges.push_back(m);
}

// The cheapest step by one sphere, where `next` takes two: its index in sequence_.bridges.
Index Collapser::findBridge(Index next) {
  while (!bridgeHeap_.empty() && stale(bridgeHeap_.top())) refresh(bridgeHeap_.top());
  if (bridgeHeap_.empty()) return record(bridgeWithoutEdge(next));
  const Index e = bridgeHeap_.top();
  if (e != lastBridgeEdge_ || graph_.edge(e).note != lastBridgeTime_) {
    const GraphEdge& g = graph_.edge(e);
    lastBridgeEdge_ = e;
    lastBridgeTime_ = graph_.edge(e).note;
    record({g.from, nodeOf(g.to), Vec3f::Zero(), 0, 0});
  }
  return static_cast<Index>(sequence_.bridges.size() - 1);
}

// No edge takes one sphere away: a pair that is next to a single node merges across the plane, one that is cheap to
// merge with that node if there is one.
Bridge Collapser::bridgeWithoutEdge(Index next) const {
  constexpr Index kTried = 64;
  const auto pairBesideSingle = [&](Index e) {
    const Index a = graph_.edge(e).from, b = nodeOf(graph_.edge(e).to);
    return graph_.single(a) == graph_.single(b) ? kNoIndex : graph_.single(a) ? b : a;
  };
  Index pair = pairBesideSingle(next);
  if (pair == kNoIndex) {
    for (const Index e : queue_.someOfTheLowest(kTried)) {
      pair = pairBesideSingle(e);
      if (pair != kNoIndex) break;
    }
  }
  if (pair == kNoIndex) pair = graph_.edge(next).from;
  return {pair, pair, Vec3f::Zero(), 0, 0};
}

Index Collapser::record(const Bridge& bridge) {
  const SphereQuadric quadric = jointQuadric(bridge.a, bridge.b, bridge.a == bridge.b);
  const Sphere sphere = boundedMinimum(quadric, jointMoments(bridge.a, bridge.b, bridge.a == bridge.b));
  sequence_.bridges.push_back({bridge.a, bridge.b, sphere.center.cast<float>(), static_cast<float>(sphere.radius),
                               static_cast<float>(quadric.weight())});
  return static_cast<Index>(sequence_.bridges.size() - 1);
}

}  // namespace

CollapseSequence collapse(const CollapseInput& input, Progress& progress) {
  return Collapser(input, progress).run();
}

}  // namespace limber
