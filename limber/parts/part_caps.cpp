#include "limber/parts/part_caps.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "limber/mesh/edge_groups.h"

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
  std::map<Index, std::size_t> placeOf;  // in `walk`
  for (std::size_t first = 0; first < edges.size(); ++first) {
    std::vector<Index> walk;
    placeOf.clear();
    Index at = edges[first].first;
    for (std::size_t next = first; !used[next];) {
      used[next] = true;
      placeOf[at] = walk.size();
      walk.push_back(at);
      at = edges[next].second;
      if (const auto met = placeOf.find(at); met != placeOf.end()) {
        const auto begin = walk.begin() + static_cast<std::ptrdiff_t>(met->second);
        loops.emplace_back(begin, walk.end());
        for (auto v = begin; v != walk.end(); ++v) placeOf.erase(*v);
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

// Fills one loop.
class LoopFiller {
 public:
  LoopFiller(const TriMesh& mesh, std::span<const Edge> partEdges, std::vector<Edge>& diagonals, PartCap& cap)
      : partEdges_(partEdges), diagonals_(diagonals), cap_(cap) {
    Vec3 u = cap.normal.unitOrthogonal();
    if (cap.normal.isZero()) u = Vec3::UnitX();
    const Vec3 v = cap.normal.cross(u);
    for (const Index vertex : cap.loop) {
      points_.push_back(mesh.position(vertex));
      flat_.emplace_back(points_.back().dot(u), points_.back().dot(v));
    }
  }

  void fill() {
    if (!clipEars()) fanOut();
  }

 private:
  using Flat = Eigen::Vector2d;

  static double turn(const Flat& a, const Flat& b, const Flat& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  }

  bool isFree(Index a, Index b) const {
    const Edge edge = lowHigh(cap_.loop[a], cap_.loop[b]);
    return !std::binary_search(partEdges_.begin(), partEdges_.end(), edge) &&
           std::find(diagonals_.begin(), diagonals_.end(), edge) == diagonals_.end();
  }

  bool isEar(std::span<const Index> rest, std::size_t i) const {
    const Index a = rest[(i + rest.size() - 1) % rest.size()], b = rest[i], c = rest[(i + 1) % rest.size()];
    if (!(turn(flat_[a], flat_[b], flat_[c]) > 0)) return false;
    if (rest.size() > 3 && !isFree(a, c)) return false;
    return std::none_of(rest.begin(), rest.end(), [&](Index p) {
      return p != a && p != b && p != c && turn(flat_[a], flat_[b], flat_[p]) >= 0 &&
             turn(flat_[b], flat_[c], flat_[p]) >= 0 && turn(flat_[c], flat_[a], flat_[p]) >= 0;
    });
  }

  // False, and nothing done, where some part of the loop has no ear.
  bool clipEars() {
    std::vector<Index> rest(cap_.loop.size());
    std::iota(rest.begin(), rest.end(), Index{0});
    const std::size_t diagonalsBefore = diagonals_.size();
    while (rest.size() > 2) {
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const Index a = rest[(i + rest.size() - 1) % rest.size()], c = rest[(i + 1) % rest.size()];
        order.emplace_back((points_[a] - points_[c]).squaredNorm(), i);
      }
      std::sort(order.begin(), order.end());
      const auto ear = std::find_if(order.begin(), order.end(), [&](const auto& at) { return isEar(rest, at.second); });
      if (ear == order.end()) {
        cap_.triangles.clear();
        diagonals_.resize(diagonalsBefore);
        return false;
      }
      const std::size_t i = ear->second;
      const Index a = rest[(i + rest.size() - 1) % rest.size()], c = rest[(i + 1) % rest.size()];
      cap_.triangles.push_back({a, rest[i], c});
      if (rest.size() > 3) diagonals_.push_back(lowHigh(cap_.loop[a], cap_.loop[c]));
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    }
    return true;
  }

  void fanOut() {
    const auto count = static_cast<Index>(cap_.loop.size());
    cap_.hasMiddle = true;
    for (Index i = 0; i < count; ++i) cap_.triangles.push_back({i, (i + 1) % count, count});
  }

  std::span<const Edge> partEdges_;
  std::vector<Edge>& diagonals_;
  PartCap& cap_;
  std::vector<Vec3> points_;
  std::vector<Flat> flat_;
};

}  // namespace

PartCaps capParts(const TriMesh& mesh, std::span<const Index> partOf, Index partCount) {
  PartCaps result;
  result.capsOf.resize(partCount);
  const std::vector<PartEdges> edges = collectEdges(mesh, partOf, partCount);
  for (Index p = 0; p < partCount; ++p) {
    std::vector<Edge> diagonals;
    for (std::vector<Index>& loop : simpleLoops(edges[p].cut, result.openEdges)) {
      PartCap& cap = result.capsOf[p].emplace_back();
      cap.loop = std::move(loop);
      const Vec3 area = loopArea(mesh, cap.loop);
      if (area.norm() > 0) cap.normal = area.normalized();
      LoopFiller(mesh, edges[p].own, diagonals, cap).fill();
    }
  }
  return result;
}

}  // namespace limber
