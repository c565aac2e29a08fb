// Tried and given up: an indexed heap of four or eight children instead of the radix heap (20,000 vertices, one thread,
// two cores, best of ten: 0.042 s against 0.032 s, two smaller changes included); a pull towards the points of 0.01 or
// more (SphereQuadric::kCentering), which draws handles out to the skin, and of 0.0001 or less, which lets spheres of
// flat parts grow out of the model. Edges are evaluated 3.75 times a merge on a smooth closed surface; evaluating all
// edges of the merged node would be 7 times.
#include "limber/rigging/sphere_mesh/collapse_sequence.h"

#include <algorithm>

#include "limber/core/parallel.h"
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

// The error of planes alone, without the pull.
float planeError(const SphereQuadric& quadric, const PartMoments& moments, const Sphere& sphere) {
  const double pull = SphereQuadric::kCentering * moments.squaredDistances(sphere.center);
  return static_cast<float>(std::max(0.0, quadric.error(sphere) - pull));
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
  void loseEnds(const Merge& m, Index end, Index countBefore);
  void fetchClusters(Index e) const;
  // Whether merging e takes one sphere away, not two.
  bool takesOne(Index e) const {
    const GraphEdge& g = graph_.edge(e);
    return nodeOf(g.to) == g.from || (graph_.single(g.from) && graph_.single(nodeOf(g.to)));
  }

  void merge(Index e);
  Index keptOf(Index e) const;
  Index betweenBefore(const Merge& next);
  Index betweenAfter();
  Index cheapestOnPlane();
  Index record(CountBetween between, const SphereQuadric& quadric, const PartMoments& moments);

  Progress& progress_;
  CollapseSequence sequence_;
  std::vector<Cluster> clusters_;  // per node
  std::vector<PartMoments> moments_;
  CollapseGraph graph_;  // an edge's note: merges done when its key was last computed
  bool symmetric_ = false;
  MonotoneQueue queue_;
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
  struct OnPlane {
    Index merge = kNoIndex;
    SphereQuadric quadric;  // of what was gone
    PartMoments moments;
  };
  OnPlane lastOnPlane_;          // the last merge of two nodes on the plane
  std::vector<Index> fewEdges_;  // all that are alive, and some that are not, from when the ends are known
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
    fewEdges_.push_back(e);
    const GraphEdge& edge = graph_.edge(e);
    graph.edges.push_back({numbers[edge.from], makeEnd(numbers[nodeOf(edge.to)], crossesOf(edge.to))});
  }
  endOf_.assign(clusters_.size(), kNoIndex);
  const std::vector<LimbEnd> limbs = limbEnds(graph);
  constexpr double kAlike = 0.8;  // of a length; such limbs are equal ones, as legs are: none goes before the others
  double alike = 0;
  for (const LimbEnd& end : limbs) {  // the longest first
    for (const Index node : end.nodes) endOf_[nodes[node]] = static_cast<Index>(ends_.size());
    if (alike == 0 || end.length < kAlike * alike) alike = end.length;
    const double squared = alike * alike;
    ends_.push_back({alike, costOfEnds_ * squared * squared, end.isOnPlane});
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
void Collapser::loseEnds(const Merge& m, Index end, Index countBefore) {
  for (const Index node : {m.kept, m.gone}) {
    const Index lost = endOf_[node];
    endOf_[node] = kNoIndex;
    if (lost == kNoIndex || lost == end) continue;
    if (std::find(endOf_.begin(), endOf_.end(), lost) != endOf_.end()) continue;  // others have it still
    const Index limbs = ends_[lost].isOnPlane ? 1 : 2;
    sequence_.lostEnds.push_back({countBefore, limbs, static_cast<float>(ends_[lost].length)});
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
  m.between = kNoIndex;
  m.error = queue_.key(e);
  const bool one = takesOne(e);
  const bool onPlane = one && symmetric_ && m.kept != m.gone && graph_.single(m.kept);
  if (onPlane) {
    lastOnPlane_ = {time, clusters_[m.gone].quadric, moments_[m.gone]};
  } else if (!one) {
    m.between = betweenBefore(m);
  }
  const Index countBefore = count_;
  count_ -= one ? 1 : 2;
  m.countAfter = count_;
  m.keptBefore = madeBy_[m.kept];
  m.goneBefore = madeBy_[m.gone];
  m.deadBegin = static_cast<Index>(sequence_.deadEdges.size());
  if (!ends_.empty()) loseEnds(m, jointEnd(e).end, countBefore);
  SphereQuadric& quadric = clusters_[m.kept].quadric;
  PartMoments& moments = moments_[m.kept];
  quadric = jointQuadric(m.kept, m.gone, m.crosses);
  moments = jointMoments(m.kept, m.gone, m.crosses);
  const Sphere sphere = boundedMinimum(quadric, moments);
  m.center = sphere.center.cast<float>();
  m.radius = static_cast<float>(sphere.radius);
  m.planeError = planeError(quadric, moments, sphere);
  m.weight = static_cast<float>(quadric.weight());

  graph_.merge(e, m.kept, queue_);
  m.single = graph_.single(m.kept);
  for (const DeadEdge& dead : graph_.dead()) {
    queue_.remove(dead.edge);
    sequence_.deadEdges.push_back(dead);
  }
  clusters_[m.kept].changed = time + 1;
  madeBy_[m.kept] = time;
  if (m.gone != m.kept) {
    clusters_[m.kept].size += clusters_[m.gone].size;
    sequence_.absorbedBy[m.gone] = time;
  }
  sequence_.merges.push_back(m);
  if (!one && m.between == kNoIndex) sequence_.merges.back().between = betweenAfter();
}

// What is done for the count between before a merge; kNoIndex if that is better done after it.
Index Collapser::betweenBefore(const Merge& next) {
  const Index e = cheapestOnPlane();
  if (e != kNoIndex) {
    const Index node = graph_.edge(e).from, gone = nodeOf(graph_.edge(e).to);
    return record({node, gone}, jointQuadric(node, gone, false), jointMoments(node, gone, false));
  }
  if (lastOnPlane_.merge != kNoIndex) return kNoIndex;
  const Index pair = graph_.single(next.gone) ? next.kept : next.gone;
  return record({pair}, clusters_[pair].quadric.withMirrorImage(), moments_[pair].withMirrorImage());
}

// The edge between two single nodes with the least key, once there are few nodes; kNoIndex if there is none.
Index Collapser::cheapestOnPlane() {
  const auto onPlane = [&](Index e) {
    return graph_.single(graph_.edge(e).from) && graph_.single(nodeOf(graph_.edge(e).to));
  };
  std::erase_if(fewEdges_, [&](Index e) { return !graph_.alive(e); });
  Index cheapest = kNoIndex;
  for (const Index e : fewEdges_) {
    if (!onPlane(e) || (cheapest != kNoIndex && queue_.key(e) >= queue_.key(cheapest))) continue;
    if (stale(e)) refresh(e);
    if (cheapest == kNoIndex || queue_.key(e) < queue_.key(cheapest)) cheapest = e;
  }
  return cheapest;
}

// What is done for it after the merge.
Index Collapser::betweenAfter() {
  Index node = sequence_.merges[lastOnPlane_.merge].kept;
  while (sequence_.absorbedBy[node] != kNoIndex) node = sequence_.merges[sequence_.absorbedBy[node]].kept;
  SphereQuadric quadric = clusters_[node].quadric;
  PartMoments moments = moments_[node];
  quadric -= lastOnPlane_.quadric;
  moments -= lastOnPlane_.moments;
  return record({node, kNoIndex, lastOnPlane_.merge}, quadric, moments);
}

// With the sphere of what `node` represents there.
Index Collapser::record(CountBetween between, const SphereQuadric& quadric, const PartMoments& moments) {
  const Sphere sphere = boundedMinimum(quadric, moments);
  between.center = sphere.center.cast<float>();
  between.radius = static_cast<float>(sphere.radius);
  between.weight = static_cast<float>(quadric.weight());
  between.planeErrorChange = planeError(quadric, moments, sphere);
  for (const Index node : {between.node, between.gone}) {
    if (node == kNoIndex || madeBy_[node] == kNoIndex) continue;
    between.planeErrorChange -= static_cast<float>(sequence_.merges[madeBy_[node]].planeErrorOfAll());
  }
  sequence_.between.push_back(between);
  return static_cast<Index>(sequence_.between.size() - 1);
}

}  // namespace

CollapseSequence collapse(const CollapseInput& input, Progress& progress) {
  return Collapser(input, progress).run();
}

}  // namespace limber
