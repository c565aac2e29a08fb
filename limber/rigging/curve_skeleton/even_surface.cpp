#include "limber/rigging/curve_skeleton/even_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "limber/core/disjoint_sets.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/edge_groups.h"

namespace limber {

namespace {

constexpr double kOnPlane = 1e-3;           // longest sides from the mirror plane within which a point is put onto it
constexpr std::size_t kMaxSplits = 50'000;  // points that splitting may add, for thousands of needles

// A new point on each of some edges.
class EdgePoints {
 public:
  void want(Index a, Index b) { edges_.push_back({std::min(a, b), std::max(a, b)}); }

  // The point of the k-th edge gets the number firstPoint + k.
  const std::vector<VertexPair>& number(Index firstPoint) {
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    first_ = firstPoint;
    return edges_;
  }

  Index at(Index a, Index b) const {
    const VertexPair edge = {std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(edges_.begin(), edges_.end(), edge);
    return found == edges_.end() || *found != edge ? kNoIndex : first_ + static_cast<Index>(found - edges_.begin());
  }

 private:
  std::vector<VertexPair> edges_;
  Index first_ = 0;
};

double areaOf(const std::vector<Vec3>& points, const Triangle& t) {
  return triangleArea(points[t[0]], points[t[1]], points[t[2]]);
}

bool isProper(const Triangle& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

// Leaves of each triangle what has x >= 0.
void clipAtPlane(std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  for (Vec3& p : points) p.x() = std::abs(p.x()) <= kOnPlane ? 0 : p.x();
  const auto crosses = [&](Index a, Index b) { return points[a].x() * points[b].x() < 0; };
  EdgePoints cuts;
  for (const Triangle& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      if (crosses(t[i], t[(i + 1) % 3])) cuts.want(t[i], t[(i + 1) % 3]);
    }
  }
  for (const auto& [a, b] : cuts.number(static_cast<Index>(points.size()))) {
    const double part = points[a].x() / (points[a].x() - points[b].x());
    Vec3 cut = points[a] + part * (points[b] - points[a]);
    cut.x() = 0;
    points.push_back(cut);
  }
  std::vector<Triangle> kept;
  for (const Triangle& t : triangles) {
    std::vector<Index> corners;
    double most = 0;
    for (int i = 0; i < 3; ++i) {
      const Index a = t[i], b = t[(i + 1) % 3];
      if (points[a].x() >= 0) corners.push_back(a);
      if (crosses(a, b)) corners.push_back(cuts.at(a, b));
      most = std::max(most, std::abs(points[a].x()));
    }
    const bool liesOnPlane = most == 0;
    const bool isOnOtherSide =
        !liesOnPlane && std::all_of(corners.begin(), corners.end(), [&](Index v) { return points[v].x() == 0; });
    if (isOnOtherSide) continue;
    for (std::size_t i = 2; i < corners.size(); ++i) kept.push_back({corners[0], corners[i - 1], corners[i]});
  }
  triangles = std::move(kept);
}

// Each hole gets a fan round a point in its middle: where a surface is open the contraction would stop short. Of a half
// what lies open at the plane is no hole.
void closeHoles(bool isHalf, std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  struct Rim {
    Vec3 sum = Vec3::Zero();
    double length = 0;
    Index middle = kNoIndex;
    bool isOnPlane = false;
  };
  const EdgeGroups groups(triangles, static_cast<Index>(points.size()));
  std::vector<VertexPair> open;
  DisjointSets sets(points.size());
  groups.forEachEdge([&](std::span<const Index> sides) {
    const Index low = groups.low(sides[0]), high = groups.high(sides[0]);
    if (sides.size() > 1 || (isHalf && points[low].x() == 0 && points[high].x() == 0)) return;
    open.push_back({low, high});
    sets.unite(low, high);
  });
  std::vector<Rim> rims(open.empty() ? 0 : points.size());
  for (const auto& [a, b] : open) {
    Rim& rim = rims[sets.find(a)];
    const double length = (points[a] - points[b]).norm() + 1e-12;
    rim.sum += 0.5 * length * (points[a] + points[b]);
    rim.length += length;
    rim.isOnPlane |= isHalf && (points[a].x() == 0 || points[b].x() == 0);
  }
  for (const auto& [a, b] : open) {
    Rim& rim = rims[sets.find(a)];
    if (rim.middle == kNoIndex) {
      rim.middle = static_cast<Index>(points.size());
      points.push_back(rim.sum / rim.length);
      if (rim.isOnPlane) points.back().x() = 0;
    }
    triangles.push_back({a, b, rim.middle});
  }
}

// One triangle by the new points in the middle of its sides; kNoIndex where a side has none.
void splitTriangle(const std::vector<Vec3>& points, Triangle v, std::array<Index, 3> m, std::vector<Triangle>& out) {
  const auto count = 3 - std::count(m.begin(), m.end(), kNoIndex);
  if (count == 0) {
    out.push_back(v);
  } else if (count == 3) {
    out.insert(out.end(), {{v[0], m[0], m[2]}, {m[0], v[1], m[1]}, {m[2], m[1], v[2]}, {m[0], m[1], m[2]}});
  } else {
    // Turned so that the first side is split and, of two, the last is not.
    while (m[0] == kNoIndex || (count == 2 && m[2] != kNoIndex)) {
      std::rotate(v.begin(), v.begin() + 1, v.end());
      std::rotate(m.begin(), m.begin() + 1, m.end());
    }
    if (count == 1) {
      out.insert(out.end(), {{v[0], m[0], v[2]}, {m[0], v[1], v[2]}});
    } else if ((points[v[0]] - points[m[1]]).squaredNorm() < (points[m[0]] - points[v[2]]).squaredNorm()) {
      out.insert(out.end(), {{m[0], v[1], m[1]}, {v[0], m[0], m[1]}, {v[0], m[1], v[2]}});
    } else {
      out.insert(out.end(), {{m[0], v[1], m[1]}, {v[0], m[0], v[2]}, {m[0], m[1], v[2]}});
    }
  }
}

void splitLongEdges(double longest, std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  const std::size_t most = points.size() + kMaxSplits;
  for (bool isSplit = true; isSplit;) {
    EdgePoints middles;
    for (const Triangle& t : triangles) {
      for (int i = 0; i < 3; ++i) {
        const Index a = t[i], b = t[(i + 1) % 3];
        if ((points[a] - points[b]).norm() > longest) middles.want(a, b);
      }
    }
    const std::vector<VertexPair>& edges = middles.number(static_cast<Index>(points.size()));
    isSplit = !edges.empty() && points.size() + edges.size() <= most;
    if (!isSplit) return;
    for (const auto& [a, b] : edges) points.push_back(0.5 * (points[a] + points[b]));
    std::vector<Triangle> finer;
    for (const Triangle& t : triangles) {
      splitTriangle(points, t, {middles.at(t[0], t[1]), middles.at(t[1], t[2]), middles.at(t[2], t[0])}, finer);
    }
    triangles = std::move(finer);
  }
}

void collectEdges(EvenSurface& surface) {
  const EdgeGroups groups(surface.triangles, static_cast<Index>(surface.points.size()));
  surface.edges.reserve(surface.triangles.size() * 3 / 2);
  groups.forEachEdge([&](std::span<const Index> sides) {
    surface.edges.push_back({groups.low(sides[0]), groups.high(sides[0])});
  });
}

void measureAreas(EvenSurface& surface) {
  surface.areas.assign(surface.points.size(), 0);
  for (const Triangle& t : surface.triangles) {
    const double third = areaOf(surface.points, t) / 3;
    for (const Index v : t) surface.areas[v] += third;
  }
}

// The surface over other points: point p becomes pointOf[p], none where that is kNoIndex.
void renumber(const std::vector<Index>& pointOf, EvenSurface& surface) {
  for (Triangle& t : surface.triangles) {
    for (Index& v : t) v = pointOf[v];
  }
  std::erase_if(surface.triangles, [](const Triangle& t) { return !isProper(t); });
  // One of those with the same corners, in whatever order.
  const auto sorted = [](Triangle t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::sort(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& a, const Triangle& b) {
    const Triangle low = sorted(a), high = sorted(b);
    return low != high ? low < high : a < b;
  });
  surface.triangles.erase(std::unique(surface.triangles.begin(), surface.triangles.end(),
                                      [&](const Triangle& a, const Triangle& b) { return sorted(a) == sorted(b); }),
                          surface.triangles.end());
  for (auto& [a, b] : surface.edges) {
    a = pointOf[a];
    b = pointOf[b];
    if (a > b) std::swap(a, b);
  }
  std::erase_if(surface.edges, [](const VertexPair& edge) { return edge[0] == edge[1]; });
  std::sort(surface.edges.begin(), surface.edges.end());
  surface.edges.erase(std::unique(surface.edges.begin(), surface.edges.end()), surface.edges.end());
}

std::uint64_t cellOf(const Vec3& p, double cell) {
  std::uint64_t key = 0;
  for (int i = 0; i < 3; ++i) key = key << 21 | static_cast<std::uint64_t>(std::floor(p[i] / cell) + (1 << 20));
  return key;
}

// Points that edges join within a cell become one, the middle of their surface.
DisjointSets gatheredInCells(const EvenSurface& surface, double cell) {
  std::vector<std::uint64_t> cells(surface.points.size());
  for (std::size_t p = 0; p < cells.size(); ++p) cells[p] = cellOf(surface.points[p], cell);
  DisjointSets sets(surface.points.size());
  for (const auto& [a, b] : surface.edges) {
    if (cells[a] == cells[b]) sets.unite(a, b);
  }
  return sets;
}

void gatherPoints(std::size_t maxPoints, double cell, EvenSurface& surface) {
  DisjointSets sets = gatheredInCells(surface, cell);
  // Pieces never merge: of so many that the cells cannot be large enough each becomes a point.
  for (; sets.count() > maxPoints && cell < 2; cell *= 1.15) sets = gatheredInCells(surface, 1.15 * cell);
  std::vector<Index> pointOf(surface.points.size(), kNoIndex);
  EvenSurface gathered;
  std::vector<double> weights;
  for (Index p = 0; p < pointOf.size(); ++p) {
    const Index first = sets.find(p);
    if (first == p) {
      pointOf[p] = static_cast<Index>(gathered.points.size());
      gathered.points.push_back(Vec3::Zero());
      gathered.areas.push_back(0);
      gathered.onPlane.push_back(0);
      weights.push_back(0);
    }
    const Index to = pointOf[p] = pointOf[first];
    const double weight = surface.areas[p] + 1e-12;
    gathered.points[to] += weight * surface.points[p];
    gathered.areas[to] += surface.areas[p];
    if (surface.onPlane[p]) gathered.onPlane[to] = 1;
    weights[to] += weight;
  }
  for (std::size_t p = 0; p < weights.size(); ++p) {
    gathered.points[p] /= weights[p];
    if (gathered.onPlane[p]) gathered.points[p].x() = 0;
  }
  surface.points = std::move(gathered.points);
  surface.areas = std::move(gathered.areas);
  surface.onPlane = std::move(gathered.onPlane);
  renumber(pointOf, surface);
}

void dropUnused(std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  std::vector<Index> pointOf(points.size(), kNoIndex);
  for (const Triangle& t : triangles) {
    for (const Index v : t) pointOf[v] = 0;
  }
  Index next = 0;
  for (Index p = 0; p < points.size(); ++p) {
    if (pointOf[p] == kNoIndex) continue;
    points[next] = points[p];
    pointOf[p] = next++;
  }
  points.resize(next);
  for (Triangle& t : triangles) {
    for (Index& v : t) v = pointOf[v];
  }
}

}  // namespace

EvenSurface evenSurface(const TriMesh& mesh, const CollapseFrame& frame, bool isMirrored, Index maxPoints) {
  EvenSurface surface;
  surface.isHalf = isMirrored;
  std::vector<Vec3>& points = surface.points;
  points.reserve(mesh.positions.size());
  surface.triangles.reserve(mesh.triangles.size());
  for (const Vec3f& p : mesh.positions) points.push_back(frame.toCollapse(p).cast<double>());
  for (const Triangle& t : mesh.triangles) {
    if (isProper(t)) surface.triangles.push_back(t);
  }
  if (isMirrored) clipAtPlane(points, surface.triangles);
  dropUnused(points, surface.triangles);
  closeHoles(isMirrored, points, surface.triangles);

  double area = 0;
  for (const Triangle& t : surface.triangles) area += areaOf(points, t);
  const std::size_t most = isMirrored ? maxPoints / 2 : maxPoints;
  // The edges of so many points in a triangular lattice.
  const double spacing = std::sqrt(area / (0.866 * static_cast<double>(most)));
  if (spacing > 0) splitLongEdges(1.5 * spacing, points, surface.triangles);
  collectEdges(surface);
  measureAreas(surface);
  surface.onPlane.assign(points.size(), 0);
  if (isMirrored) {
    for (std::size_t p = 0; p < points.size(); ++p) surface.onPlane[p] = points[p].x() == 0;
  }
  if (points.size() > most) gatherPoints(most, std::max(spacing, 1e-3), surface);
  return surface;
}

UnfoldedSurface unfolded(const EvenSurface& surface) {
  UnfoldedSurface whole;
  for (const Vec3& p : surface.points) whole.mesh.positions.push_back(p.cast<float>());
  whole.mesh.triangles = surface.triangles;
  if (!surface.isHalf) return whole;
  for (Index p = 0; p < surface.points.size(); ++p) {
    whole.image.push_back(surface.onPlane[p] ? p : whole.mesh.vertexCount());
    if (surface.onPlane[p]) continue;
    const Vec3f point = whole.mesh.positions[p];
    whole.mesh.positions.push_back({-point.x(), point.y(), point.z()});
  }
  for (const Triangle& t : surface.triangles) {
    const Triangle mirrored = {whole.image[t[0]], whole.image[t[2]], whole.image[t[1]]};
    if (surface.onPlane[t[0]] && surface.onPlane[t[1]] && surface.onPlane[t[2]]) continue;
    whole.mesh.triangles.push_back(mirrored);
  }
  return whole;
}

}  // namespace limber
