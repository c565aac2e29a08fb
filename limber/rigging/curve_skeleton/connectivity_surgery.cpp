#include "limber/rigging/curve_skeleton/connectivity_surgery.h"

#include <algorithm>
#include <queue>
#include <tuple>

#include "limber/core/disjoint_sets.h"

namespace limber {

namespace {

constexpr double kSamplingWeight = 0.1;  // the paper's, against 1 of the shape

// A sum of squared distances from lines: x' a x - 2 b' x + c.
struct LineQuadric {
  Mat3 a = Mat3::Zero();
  Vec3 b = Vec3::Zero();
  double c = 0;

  void addLine(const Vec3& point, const Vec3& direction) {
    const Mat3 across = Mat3::Identity() - direction * direction.transpose();
    a += across;
    b += across * point;
    c += point.dot(across * point);
  }
  void operator+=(const LineQuadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  double at(const Vec3& x) const { return std::max(0.0, x.dot(a * x) - 2 * b.dot(x) + c); }
};

class Surgery {
 public:
  Surgery(const EvenSurface& surface, const std::vector<Vec3>& points)
      : surface_(surface),
        points_(points),
        sets_(points.size()),
        isGone_(points.size(), 0),
        quadrics_(points.size()),
        neighbors_(points.size()),
        triangles_(points.size()),
        corners_(surface.triangles) {
    for (const auto& [a, b] : surface.edges) {
      neighbors_[a].push_back(b);
      neighbors_[b].push_back(a);
      const Vec3 along = points[b] - points[a];
      if (!(along.norm() > 0)) continue;
      for (const Index v : {a, b}) quadrics_[v].addLine(points[a], along.normalized());
    }
    for (std::vector<Index>& list : neighbors_) std::sort(list.begin(), list.end());
    for (Index t = 0; t < corners_.size(); ++t) {
      for (const Index v : corners_[t]) triangles_[v].push_back(t);
    }
  }

  CurveGraph run() {
    for (Index v = 0; v < neighbors_.size(); ++v) pushFrom(v);
    while (!queue_.empty()) {
      const auto [known, from, to] = queue_.top();
      queue_.pop();
      if (!mayCollapse(from, to)) continue;
      const double now = cost(from, to);
      if (now > known) {
        queue_.push({now, from, to});
      } else {
        collapse(from, to);
      }
    }
    return result();
  }

 private:
  using Entry = std::tuple<double, Index, Index>;

  bool isNeighbor(Index a, Index b) const { return std::binary_search(neighbors_[a].begin(), neighbors_[a].end(), b); }
  bool mayCollapse(Index from, Index to) const {
    if (isGone_[from] || isGone_[to] || !isNeighbor(from, to)) return false;
    if (surface_.onPlane[from] && !surface_.onPlane[to]) return false;
    return std::any_of(triangles_[from].begin(), triangles_[from].end(), [&](Index t) { return hasCorner(t, to); });
  }
  bool hasCorner(Index t, Index v) const {
    return std::find(corners_[t].begin(), corners_[t].end(), v) != corners_[t].end();
  }

  double cost(Index from, Index to) const {
    double drawn = 0;
    for (const Index other : neighbors_[from]) drawn += (points_[from] - points_[other]).norm();
    const double shape = quadrics_[from].at(points_[to]) + quadrics_[to].at(points_[to]);
    return shape + kSamplingWeight * (points_[from] - points_[to]).norm() * drawn;
  }
  void pushFrom(Index v) {
    for (const Index other : neighbors_[v]) {
      if (mayCollapse(v, other)) queue_.push({cost(v, other), v, other});
    }
  }

  void collapse(Index from, Index to);
  void moveTriangles(Index from, Index to);
  CurveGraph result();

  const EvenSurface& surface_;
  const std::vector<Vec3>& points_;
  DisjointSets sets_;
  std::vector<char> isGone_;
  std::vector<LineQuadric> quadrics_;
  std::vector<std::vector<Index>> neighbors_, triangles_;  // per living point, ascending
  std::vector<Triangle> corners_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

// Triangles of both become none; of two that become one the first stays.
void Surgery::moveTriangles(Index from, Index to) {
  const auto drop = [&](Index t) {
    for (const Index v : corners_[t]) {
      if (v != from) std::erase(triangles_[v], t);
    }
  };
  for (const Index t : triangles_[from]) {
    if (hasCorner(t, to)) {
      drop(t);
      continue;
    }
    Triangle moved = corners_[t];
    std::replace(moved.begin(), moved.end(), from, to);
    const bool isKnown = std::any_of(triangles_[to].begin(), triangles_[to].end(), [&](Index other) {
      return hasCorner(other, moved[0]) && hasCorner(other, moved[1]) && hasCorner(other, moved[2]);
    });
    if (isKnown) {
      drop(t);
    } else {
      corners_[t] = moved;
      triangles_[to].push_back(t);
    }
  }
  triangles_[from].clear();
}

void Surgery::collapse(Index from, Index to) {
  moveTriangles(from, to);
  for (const Index other : neighbors_[from]) {
    std::erase(neighbors_[other], from);
    if (other == to || isNeighbor(other, to)) continue;
    for (const auto& [a, b] : {std::pair(other, to), std::pair(to, other)}) {
      neighbors_[a].insert(std::lower_bound(neighbors_[a].begin(), neighbors_[a].end(), b), b);
    }
  }
  neighbors_[from].clear();
  quadrics_[to] += quadrics_[from];
  isGone_[from] = 1;
  sets_.unite(from, to);
  pushFrom(to);
  for (const Index other : neighbors_[to]) {
    if (mayCollapse(other, to)) queue_.push({cost(other, to), other, to});
  }
}

CurveGraph Surgery::result() {
  CurveGraph graph;
  std::vector<Index> numbers(points_.size(), kNoIndex);
  graph.nodeOf.resize(points_.size());
  for (Index p = 0; p < points_.size(); ++p) {
    const Index set = sets_.find(p);
    if (numbers[set] == kNoIndex) numbers[set] = graph.nodeCount++;
    graph.nodeOf[p] = numbers[set];
  }
  for (Index p = 0; p < points_.size(); ++p) {
    if (isGone_[p]) continue;
    for (const Index other : neighbors_[p]) {
      if (p < other) {
        const auto [low, high] = std::minmax(graph.nodeOf[p], graph.nodeOf[other]);
        graph.edges.push_back({low, high});
      }
    }
  }
  std::sort(graph.edges.begin(), graph.edges.end());
  return graph;
}

// A branch from its end to the node that it comes off.
struct Stub {
  double length = 0;
  std::vector<Index> nodes;
  Index carrier = kNoIndex;
};

// In the whole model a node on the plane has each neighbour beside it twice.
std::vector<Stub> branchesWithEnds(const std::vector<NodePlacement>& placements, const std::vector<VertexPair>& edges) {
  std::vector<std::vector<Index>> neighbors(placements.size());
  std::vector<int> degree(placements.size(), 0);
  for (const auto& [a, b] : edges) {
    neighbors[a].push_back(b);
    neighbors[b].push_back(a);
    degree[a] += !placements[a].isPaired && placements[b].isPaired ? 2 : 1;
    degree[b] += !placements[b].isPaired && placements[a].isPaired ? 2 : 1;
  }
  std::vector<Stub> stubs;
  for (Index end = 0; end < placements.size(); ++end) {
    if (degree[end] != 1) continue;
    Stub stub;
    Index before = kNoIndex, node = end;
    while (degree[node] <= 2) {
      stub.nodes.push_back(node);
      const auto next =
          std::find_if(neighbors[node].begin(), neighbors[node].end(), [&](Index n) { return n != before; });
      if (next == neighbors[node].end()) break;
      stub.length += (placements[node].point - placements[*next].point).norm();
      before = node;
      node = *next;
    }
    if (degree[node] <= 2) continue;  // all of a piece is one curve
    // What lies on the plane stays on it.
    const bool holdsPlane =
        std::any_of(stub.nodes.begin(), stub.nodes.end(), [&](Index n) { return !placements[n].isPaired; });
    if (placements[node].isPaired && holdsPlane) continue;
    stub.carrier = node;
    stubs.push_back(std::move(stub));
  }
  std::sort(stubs.begin(), stubs.end(), [](const Stub& a, const Stub& b) {
    return a.length != b.length ? a.length < b.length : a.nodes.front() < b.nodes.front();
  });
  return stubs;
}

// The graph with each node replaced; numbers that none has any more are closed up.
void renumberNodes(std::vector<Index> to, CurveGraph& graph) {
  std::vector<Index> number(to.size(), kNoIndex);
  graph.nodeCount = 0;
  for (Index n = 0; n < to.size(); ++n) {
    if (to[n] == n) number[n] = graph.nodeCount++;
  }
  for (Index& n : to) n = number[n];
  for (Index& n : graph.nodeOf) n = to[n];
  for (auto& [a, b] : graph.edges) {
    a = to[a];
    b = to[b];
    if (a > b) std::swap(a, b);
  }
  std::erase_if(graph.edges, [](const VertexPair& edge) { return edge[0] == edge[1]; });
  std::sort(graph.edges.begin(), graph.edges.end());
}

}  // namespace

CurveGraph curveGraph(const EvenSurface& surface, const std::vector<Vec3>& contracted) {
  return Surgery(surface, contracted).run();
}

std::vector<NodePlacement> nodePlacements(const EvenSurface& surface, const CurveGraph& graph) {
  std::vector<NodePlacement> placements(graph.nodeCount);
  const auto weightOf = [&](Index p) { return surface.areas[p] + 1e-15; };
  for (NodePlacement& node : placements) node.isPaired = surface.isHalf;
  for (Index p = 0; p < graph.nodeOf.size(); ++p) {
    NodePlacement& node = placements[graph.nodeOf[p]];
    node.point += weightOf(p) * surface.points[p];
    node.area += weightOf(p);
    if (surface.onPlane[p]) node.isPaired = false;
  }
  for (NodePlacement& node : placements) {
    node.point /= node.area;
    if (surface.isHalf && !node.isPaired) node.point.x() = 0;
  }
  for (Index p = 0; p < graph.nodeOf.size(); ++p) {
    NodePlacement& node = placements[graph.nodeOf[p]];
    node.radius += weightOf(p) / node.area * (surface.points[p] - node.point).norm();
  }
  return placements;
}

void absorbStubs(const EvenSurface& surface, CurveGraph& graph) {
  for (bool isChanged = true; isChanged;) {
    isChanged = false;
    const std::vector<NodePlacement> placements = nodePlacements(surface, graph);
    for (const Stub& stub : branchesWithEnds(placements, graph.edges)) {
      std::vector<Index> to(graph.nodeCount);
      for (Index n = 0; n < to.size(); ++n) to[n] = n;
      for (const Index n : stub.nodes) to[n] = stub.carrier;
      CurveGraph absorbed = graph;
      renumberNodes(to, absorbed);
      // Numbers below the carrier's own that are gone.
      Index carrier = stub.carrier;
      for (const Index n : stub.nodes) carrier -= n < stub.carrier;
      const NodePlacement both = nodePlacements(surface, absorbed)[carrier];
      if ((placements[stub.nodes.front()].point - both.point).norm() > both.radius) continue;
      graph = std::move(absorbed);
      isChanged = true;
      break;
    }
  }
}

}  // namespace limber
