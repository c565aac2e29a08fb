#include "limber/geometry/mesh/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "limber/core/file/bits.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

constexpr double kNoise = 0x1p-20;          // of the longest side: a few roundings in single precision
constexpr double kFloatRounding = 0x1p-22;  // of the largest coordinate: one rounding of three, and some to spare
constexpr double kRoundedEdge = 1.0 / 16;   // of the median edge: what joins by rounding is far below any detail
constexpr double kGridEdge = 1;             // of the median edge: what joins across grids is below it
constexpr std::size_t kEdgeSamples = 1 << 16;

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  hash = (hash ^ value) * 0x9e3779b97f4a7c15u;
  return hash ^ hash >> 32;
}

// Open addressing: each slot holds a vertex, keyed by its position's bits. The lowest vertex at each position.
std::vector<Index> equalPositions(std::span<const Vec3f> positions) {
  std::vector<Index> slots(std::bit_ceil(2 * positions.size() + 2), kNoIndex);
  const std::size_t mask = slots.size() - 1;
  std::vector<Index> lowest(positions.size());
  for (Index v = 0; v < positions.size(); ++v) {
    std::uint64_t hash = 0;
    for (int i = 0; i < 3; ++i) hash = mixed(hash, bitCast<std::uint32_t>(positions[v][i] + 0.0f));  // turns -0 into 0
    std::size_t slot = hash & mask;
    while (slots[slot] != kNoIndex && positions[slots[slot]] != positions[v]) slot = (slot + 1) & mask;
    if (slots[slot] == kNoIndex) slots[slot] = v;
    lowest[v] = slots[slot];
  }
  return lowest;
}

// Points by their cell, in grids whose cells grow with the points' reach, so that a cell holds few of them.
class PointCells {
 public:
  PointCells(std::span<const Vec3f> positions, std::size_t count)
      : positions_(positions), slots_(std::bit_ceil(2 * count + 2), kNoIndex) {}

  // reach  above 0
  void add(Index point, double reach) {
    const int level = std::ilogb(reach);
    if (std::find(levels_.begin(), levels_.end(), level) == levels_.end()) levels_.push_back(level);
    std::size_t slot = slotOf(level, cellOf(positions_[point].cast<double>(), level));
    while (slots_[slot] != kNoIndex) slot = next(slot);
    slots_[slot] = point;
  }

  // Calls visit(point) for those no farther from p than `radius` and than their own reach; for others, too, and for
  // some twice.
  template <class Visit>
  void forNear(const Vec3f& p, double radius, const Visit& visit) const {
    for (const int level : levels_) {
      const Vec3 reach = Vec3::Constant(std::min(radius, std::ldexp(2.0, level)));
      const Vec3 low = cellOf(p.cast<double>() - reach, level), high = cellOf(p.cast<double>() + reach, level);
      for (int corner = 0; corner < 8; ++corner) {  // a reach is at most a quarter of a cell
        Vec3 cell = low;
        bool isNew = true;
        for (int axis = 0; axis < 3; ++axis) {
          if ((corner >> axis & 1) == 0) continue;
          cell[axis] = high[axis];
          isNew = isNew && high[axis] != low[axis];
        }
        if (!isNew) continue;
        for (std::size_t slot = slotOf(level, cell); slots_[slot] != kNoIndex; slot = next(slot)) visit(slots_[slot]);
      }
    }
  }

 private:
  static Vec3 cellOf(const Vec3& p, int level) {
    const double size = std::ldexp(8.0, level);
    return {std::floor(p.x() / size), std::floor(p.y() / size), std::floor(p.z() / size)};
  }
  std::size_t slotOf(int level, const Vec3& cell) const {
    std::uint64_t hash = static_cast<std::uint64_t>(static_cast<std::int64_t>(level));
    for (int i = 0; i < 3; ++i) hash = mixed(hash, bitCast<std::uint64_t>(cell[i] + 0.0));
    return hash & (slots_.size() - 1);
  }
  std::size_t next(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }

  std::span<const Vec3f> positions_;
  std::vector<int> levels_;
  std::vector<Index> slots_;
};

class Welder {
 public:
  Welder(std::span<const Vec3f> positions, std::span<const Triangle> triangles, std::span<const StoredVertices> stored)
      : positions_(positions),
        triangles_(triangles),
        ranges_(stored.begin(), stored.end()),
        same_(equalPositions(positions)),
        rangeOf_(positions.size(), static_cast<Index>(stored.size())) {
    for (Index r = 0; r < stored.size(); ++r) {
      std::fill_n(rangeOf_.begin() + stored[r].first, stored[r].count, r);
    }
    ranges_.emplace_back();
  }

  std::vector<Index> weld() {
    const double longestSide =
        modelBox({std::vector<Vec3f>(positions_.begin(), positions_.end()), weldedTriangles()}).longestSide();
    if (longestSide > 0) {
      medianEdges();
      noise_ = kNoise * longestSide;
      joinRounded();
      if (std::any_of(ranges_.begin(), ranges_.end(), [](const auto& r) { return r.quantisation > 0; })) joinSeams();
    }
    return std::move(same_);
  }

 private:
  using Pair = std::pair<Index, Index>;
  struct Match {
    double squaredDistance;
    Index a, b;
    std::tuple<double, Index, Index> order() const { return {squaredDistance, a, b}; }
  };

  double squaredDistance(Index a, Index b) const {
    return (positions_[a].cast<double>() - positions_[b].cast<double>()).squaredNorm();
  }

  std::vector<Triangle> weldedTriangles() const {
    std::vector<Triangle> result;
    result.reserve(triangles_.size());
    for (const Triangle& source : triangles_) {
      const Triangle t = {same_[source[0]], same_[source[1]], same_[source[2]]};
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result.push_back(t);
    }
    return result;
  }

  // By range; of a sample where there are many. Infinite without triangles.
  void medianEdges() {
    std::vector<std::size_t> count(ranges_.size(), 0), visited(ranges_.size(), 0);
    for (const Triangle& t : triangles_) ++count[rangeOf_[t[0]]];
    std::vector<std::vector<double>> lengths(ranges_.size());
    for (const Triangle& t : triangles_) {
      const Index range = rangeOf_[t[0]];
      if (visited[range]++ % (1 + 3 * count[range] / kEdgeSamples) != 0) continue;
      for (int i = 0; i < 3; ++i) {
        const double squared = squaredDistance(t[i], t[(i + 1) % 3]);
        if (squared > 0) lengths[range].push_back(squared);
      }
    }
    for (std::vector<double>& of : lengths) {
      const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
      std::nth_element(of.begin(), middle, of.end());
      medianEdge_.push_back(of.empty() ? std::numeric_limits<double>::infinity() : std::sqrt(*middle));
    }
  }

  // How far rounding has moved the vertex.
  double rounding(Index v) const {
    const Vec3 p = positions_[v].cast<double>();
    const double stored = (p - ranges_[rangeOf_[v]].origin).cwiseAbs().maxCoeff();
    return 0.5 * noise_ + kFloatRounding * (p.cwiseAbs().maxCoeff() + stored);
  }

  void joinRounded() {
    std::vector<bool> isOfSurface(positions_.size(), false);
    double most = 0.5 * noise_;
    for (const Triangle& t : triangles_) {
      for (const Index v : t) isOfSurface[same_[v]] = true;
    }
    for (Index v = 0; v < positions_.size(); ++v) {
      if (isOfSurface[v]) most = std::max(most, rounding(v));
    }
    const auto radiusOf = [&](Index v) { return isOfSurface[v] ? rounding(v) : 0.5 * noise_; };
    const auto capOf = [&](Index v) { return kRoundedEdge * medianEdge_[rangeOf_[v]]; };
    PointCells cells(positions_, positions_.size());
    for (Index v = 0; v < positions_.size(); ++v) {
      if (same_[v] != v) {  // the one at the same position has been looked at
        same_[v] = same_[same_[v]];
        continue;
      }
      Match nearest = {std::numeric_limits<double>::infinity(), v, v};
      const double radius = radiusOf(v), cap = capOf(v), reach = std::min(radius + most, cap);
      cells.forNear(positions_[v], reach, [&](Index w) {
        const Match match = {squaredDistance(v, w), v, w};
        if (match.squaredDistance > reach * reach || !(match.order() < nearest.order())) return;
        const double allowed = std::min({radius + radiusOf(w), cap, capOf(w)});
        if (match.squaredDistance <= allowed * allowed) nearest = match;
      });
      same_[v] = nearest.b;
      if (nearest.b == v) cells.add(v, reach);
    }
  }

  // Those of one triangle as the file has them, if no other lies at the same position. Two that do and have a vertex in
  // common are open as well: a grid has closed the notch between them.
  std::vector<Pair> openEdges() const {
    std::vector<Triangle> triangles;
    std::copy_if(triangles_.begin(), triangles_.end(), std::back_inserter(triangles),
                 [](const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; });
    const EdgeGroups groups(triangles, static_cast<Index>(positions_.size()));
    std::vector<std::pair<Pair, Pair>> edges;  // its points and its vertices
    groups.forEachEdge([&](std::span<const Index> sides) {
      const Index low = groups.low(sides[0]), high = groups.high(sides[0]);
      if (sides.size() > 1 || same_[low] == same_[high]) return;
      edges.push_back({std::minmax(same_[low], same_[high]), {low, high}});
    });
    std::sort(edges.begin(), edges.end());
    std::vector<Pair> result;
    std::vector<Index> vertices;
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      vertices.clear();
      for (; end < edges.size() && edges[end].first == edges[begin].first; ++end) {
        vertices.insert(vertices.end(), {edges[end].second.first, edges[end].second.second});
      }
      std::sort(vertices.begin(), vertices.end());
      const bool isNotch = std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end();
      if (end == begin + 1 || isNotch) result.push_back(edges[begin].first);
    }
    return result;
  }

  // Of each vertex on an open edge and each other range, one of the two with a grid: the range's nearest vertex on an
  // open edge, within what the grids explain. By both.
  std::map<Pair, Match> nearestAcross(const std::vector<Pair>& openEdges) const {
    std::set<Index> openVertices;
    for (const auto& [a, b] : openEdges) openVertices.insert({a, b});
    const auto gridOf = [&](Index v) { return ranges_[rangeOf_[v]].quantisation; };
    const auto capOf = [&](Index v) { return kGridEdge * medianEdge_[rangeOf_[v]]; };
    double most = 0;
    for (const Index v : openVertices) most = std::max(most, gridOf(v) + rounding(v));
    const auto reachOf = [&](Index v) { return std::min(gridOf(v) + rounding(v) + most, capOf(v)); };
    PointCells cells(positions_, openVertices.size());
    for (const Index v : openVertices) cells.add(v, reachOf(v));
    std::map<Pair, Match> nearest;
    for (const Index a : openVertices) {
      cells.forNear(positions_[a], reachOf(a), [&](Index b) {
        if (rangeOf_[a] == rangeOf_[b] || !(gridOf(a) + gridOf(b) > 0)) return;
        const double allowed = std::min({gridOf(a) + rounding(a) + gridOf(b) + rounding(b), capOf(a), capOf(b)});
        const Match match = {squaredDistance(a, b), a, b};
        if (match.squaredDistance > allowed * allowed) return;
        const auto [found, isNew] = nearest.try_emplace({a, rangeOf_[b]}, match);
        if (!isNew && match.order() < found->second.order()) found->second = match;
      });
    }
    return nearest;
  }

  // How many points two ranges have in common.
  std::map<Pair, std::size_t> meetings() const {
    std::set<std::tuple<Index, Index, Index>> met;
    std::map<Pair, std::size_t> result;
    for (Index v = 0; v < positions_.size(); ++v) {
      const Index a = rangeOf_[same_[v]], b = rangeOf_[v];
      if (a != b && met.insert({same_[v], a, b}).second) ++result[std::minmax(a, b)];
    }
    return result;
  }

  void joinSeams() {
    const std::vector<Pair> openEdges = this->openEdges();
    const std::map<Pair, Match> nearest = nearestAcross(openEdges);
    if (nearest.empty()) return;
    std::map<Pair, std::size_t> mutual, met = meetings();
    std::set<Pair> matches;  // in either order
    for (const auto& [key, match] : nearest) {
      const auto back = nearest.find({match.b, rangeOf_[match.a]});
      const bool isMutual = back != nearest.end() && back->second.b == match.a;
      if (isMutual && match.a < match.b) ++mutual[std::minmax(rangeOf_[match.a], rangeOf_[match.b])];
      matches.insert({{match.a, match.b}, {match.b, match.a}});
    }
    for (const auto& [a, b] : matchesAlongSeams(matches, openEdges)) {
      const Pair ranges = std::minmax(rangeOf_[a], rangeOf_[b]);
      if (met[ranges] < mutual[ranges]) join(a, b);
    }
    for (Index& v : same_) v = same_[v];
  }

  // Those with an open edge to another match's vertices, or to one vertex that both sides have already; and on from
  // these those with an open edge on one side and the same vertex on the other.
  static std::set<Pair> matchesAlongSeams(const std::set<Pair>& matches, const std::vector<Pair>& openEdges) {
    std::map<Index, std::vector<Index>> beside;
    for (const auto& [a, b] : openEdges) {
      beside[a].push_back(b);
      beside[b].push_back(a);
    }
    std::set<Pair> result;
    std::vector<Pair> front;
    const auto add = [&](const Pair& match) {
      if (result.insert(match).second) front.push_back(match);
    };
    for (const auto& [a, b] : matches) {
      for (const Index c : beside[a]) {
        for (const Index d : beside[b]) {
          const bool isItself = c == b && d == a;
          if (c == d || (!isItself && matches.count({c, d}) > 0)) add({a, b});
        }
      }
    }
    while (!front.empty()) {
      const auto [a, b] = front.back();
      front.pop_back();
      add({b, a});
      for (const Index c : beside[a]) {
        if (matches.count({c, b}) > 0) add({c, b});
      }
    }
    return result;
  }

  Index pointOf(Index v) {
    for (; same_[v] != v; v = same_[v]) same_[v] = same_[same_[v]];
    return v;
  }
  void join(Index a, Index b) {
    const auto [low, high] = std::minmax({pointOf(a), pointOf(b)});
    same_[high] = low;
  }

  std::span<const Vec3f> positions_;
  std::span<const Triangle> triangles_;
  std::vector<StoredVertices> ranges_;  // the last for all vertices outside of the others
  std::vector<Index> same_;
  std::vector<Index> rangeOf_;
  std::vector<double> medianEdge_;  // by range
  double noise_ = 0;
};

}  // namespace

std::vector<Index> samePoints(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                              std::span<const StoredVertices> stored) {
  return Welder(positions, triangles, stored).weld();
}

}  // namespace limber
