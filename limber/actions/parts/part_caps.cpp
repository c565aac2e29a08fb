#include "limber/actions/parts/part_caps.h"

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "limber/geometry/mesh/edge_groups.h"

namespace limber {

namespace {

using Edge = std::pair<Index, Index>;  // from, to; or low, high

Edge lowHigh(Index a, Index b) {
  return {std::min(a, b), std::max(a, b)};
}

// What a part has of edges, and the directed edges that its caps must have.
struct PartEdges {
  std::vector<Edge> own;  // low, high; sorted
  std::vector<Edge> cut;  // sorted
};

std::vector<PartEdges> collectEdges(const TriMesh& mesh, std::span<const Index> partOf, Index partCount) {
  std::vector<PartEdges> parts(partCount);
  const EdgeGroups groups(mesh.triangles, mesh.vertexCount());
  groups.forEachEdge([&](std::span<const Index> sides) {
    const Edge edge = {groups.low(sides[0]), groups.high(sides[0])};
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Index part = partOf[sides[i] / 3];
      const auto isSame = [&](Index side) { return partOf[side / 3] == part; };
      if (std::any_of(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(i), isSame)) continue;
      parts[part].own.push_back(edge);
      if (std::all_of(sides.begin(), sides.end(), isSame)) continue;
      int excess = 0;  // sides that ascend less those that descend
      for (const Index side : sides) {
        if (isSame(side)) excess += groups.ascends(side) ? 1 : -1;
      }
      for (; excess > 0; --excess) parts[part].cut.emplace_back(edge.second, edge.first);
      for (; excess < 0; ++excess) parts[part].cut.push_back(edge);
    }
  });
  for (PartEdges& part : parts) std::sort(part.cut.begin(), part.cut.end());
  return parts;
}

// Simple loops out of directed edges; a walk that comes by a vertex once more leaves a loop there.
std::vector<std::vector<Index>> simpleLoops(std::span<const Edge> edges, std::size_t& openEdges) {
  std::vector<std::vector<Index>> loops;
  std::vector<bool> used(edges.size(), false);
  std::map<Index, std::size_t> positionOf;  // in `walk`
  for (std::size_t first = 0; first < edges.size(); ++first) {
    std::vector<Index> walk;
    positionOf.clear();
    Index at = edges[first].first;
    for (std::size_t next = first; !used[next];) {
      used[next] = true;
      positionOf[at] = walk.size();
      walk.push_back(at);
      at = edges[next].second;
      if (const auto met = positionOf.find(at); met != positionOf.end()) {
        const auto begin = walk.begin() + static_cast<std::ptrdiff_t>(met->second);
        loops.emplace_back(begin, walk.end());
        for (auto v = begin; v != walk.end(); ++v) positionOf.erase(*v);
        walk.erase(begin, walk.end());
      }
      next = static_cast<std::size_t>(std::lower_bound(edges.begin(), edges.end(), Edge{at, 0}) - edges.begin());
      while (next < edges.size() && edges[next].first == at && used[next]) ++next;
      if (next == edges.size() || edges[next].first != at) break;
    }
    openEdges += walk.size();
  }
  return loops;
}

// Of the loop's plane: twice the area, along the normal (Newell).
Vec3 loopArea(const TriMesh& mesh, std::span<const Index> loop) {
  const Vec3 origin = mesh.position(loop[0]);
  Vec3 area = Vec3::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    area += (mesh.position(loop[i]) - origin).cross(mesh.position(loop[(i + 1) % loop.size()]) - origin);
  }
  return area;
}

// Fills one loop. An ear stays one until a neighbour goes, so that each is looked at a few times only.
class LoopFiller {
 public:
  LoopFiller(const TriMesh& mesh, std::span<const Edge> partEdges, std::set<Edge>& diagonals, PartCap& cap)
      : partEdges_(partEdges), diagonals_(diagonals), cap_(cap) {
    Vec3 u = cap.normal.unitOrthogonal();
    if (cap.normal.isZero()) u = Vec3::UnitX();
    const Vec3 v = cap.normal.cross(u);
    for (const Index vertex : cap.loop) {
      points_.push_back(mesh.position(vertex));
      flat_.emplace_back(points_.back().dot(u), points_.back().dot(v));
    }
  }

  // Calls `heartbeat`, which may throw, every few ears.
  void fill(const std::function<void()>& heartbeat) {
    if (!clipEars(heartbeat)) fanOut();
  }

 private:
  using Flat = Eigen::Vector2d;

  static constexpr std::size_t kEarsBetweenBeats = 256;

  // A corner between its neighbours of the moment; the shortest diagonal first.
  struct Candidate {
    double length = 0;  // squared
    Index at = 0, before = 0, after = 0;

    bool operator>(const Candidate& other) const {
      return length != other.length ? length > other.length : at > other.at;
    }
  };
  using Candidates = std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>>;

  static double turn(const Flat& a, const Flat& b, const Flat& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }

  bool isFree(Index a, Index b) const {
    const Edge edge = lowHigh(cap_.loop[a], cap_.loop[b]);
    return !std::binary_search(partEdges_.begin(), partEdges_.end(), edge) && diagonals_.count(edge) == 0;
  }

  bool isEar(const Candidate& corner) const {
    const Index a = corner.before, b = corner.at, c = corner.after;
    if (!(turn(flat_[a], flat_[b], flat_[c]) > 0)) return false;
    if (left_ > 3 && !isFree(a, c)) return false;
    for (Index p = next_[c]; p != a; p = next_[p]) {
      if (p != c && turn(flat_[a], flat_[b], flat_[p]) >= 0 && turn(flat_[b], flat_[c], flat_[p]) >= 0 &&
          turn(flat_[c], flat_[a], flat_[p]) >= 0) {
        return false;
      }
    }
    return true;
  }

  void linkAll() {
    left_ = cap_.loop.size();
    const auto count = static_cast<Index>(left_);
    for (Index i = 0; i < count; ++i) {
      previous_.push_back((i + count - 1) % count);
      next_.push_back((i + 1) % count);
    }
  }

  void offer(Index at, Candidates& candidates) const {
    const Index a = previous_[at], c = next_[at];
    candidates.push({(points_[a] - points_[c]).squaredNorm(), at, a, c});
  }

  // The next ear, and none where no corner that is left is one. Corners of loops that cross themselves, or that lost
  // their diagonal to another ear, may become ears later: where the queue runs dry all are looked at once more.
  std::optional<Candidate> takeEar(Candidates& candidates, Index any) const {
    for (const bool isLast : {false, true}) {
      while (!candidates.empty()) {
        const Candidate corner = candidates.top();
        candidates.pop();
        const bool isStale = next_[corner.before] != corner.at || next_[corner.at] != corner.after;
        if (!isStale && isEar(corner)) return corner;
      }
      if (isLast) break;
      Index at = any;
      do {
        offer(at, candidates);
        at = next_[at];
      } while (at != any);
    }
    return std::nullopt;
  }

  // False, and nothing done, where some part of the loop has no ear.
  bool clipEars(const std::function<void()>& heartbeat) {
    linkAll();
    Candidates candidates;
    std::vector<Edge> added;
    Index any = 0;  // that is left
    while (left_ > 2) {
      if (left_ % kEarsBetweenBeats == 0) heartbeat();
      const std::optional<Candidate> ear = takeEar(candidates, any);
      if (!ear) {
        cap_.triangles.clear();
        for (const Edge& edge : added) diagonals_.erase(edge);
        return false;
      }
      const auto [length, at, a, c] = *ear;
      cap_.triangles.push_back({a, at, c});
      if (left_ > 3) {
        added.push_back(lowHigh(cap_.loop[a], cap_.loop[c]));
        diagonals_.insert(added.back());
      }
      next_[a] = c;
      previous_[c] = a;
      next_[at] = kNoIndex;
      any = a;
      --left_;
      offer(a, candidates);
      offer(c, candidates);
    }
    return true;
  }

  void fanOut() {
    const auto count = static_cast<Index>(cap_.loop.size());
    cap_.hasMiddle = true;
    for (Index i = 0; i < count; ++i) cap_.triangles.push_back({i, (i + 1) % count, count});
  }

  std::span<const Edge> partEdges_;
  std::set<Edge>& diagonals_;
  PartCap& cap_;
  std::vector<Vec3> points_;
  std::vector<Flat> flat_;
  std::vector<Index> previous_, next_;  // of the corners that are left; next_ is kNoIndex for the others
  std::size_t left_ = 0;
};

}  // namespace

PartCaps capParts(const TriMesh& mesh, std::span<const Index> partOf, Index partCount, Progress& progress) {
  PartCaps result;
  result.capsOf.resize(partCount);
  const std::vector<PartEdges> edges = collectEdges(mesh, partOf, partCount);
  for (Index p = 0; p < partCount; ++p) {
    const auto heartbeat = [&] { progress.update(static_cast<double>(p) / partCount); };
    heartbeat();
    std::set<Edge> diagonals;
    for (std::vector<Index>& loop : simpleLoops(edges[p].cut, result.openEdges)) {
      PartCap& cap = result.capsOf[p].emplace_back();
      cap.loop = std::move(loop);
      const Vec3 area = loopArea(mesh, cap.loop);
      if (area.norm() > 0) cap.normal = area.normalized();
      LoopFiller(mesh, edges[p].own, diagonals, cap).fill(heartbeat);
    }
  }
  return result;
}

}  // namespace limber
