#include "limber/samples/half_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/mesh/normals.h"
#include "limber/geometry/mesh/vertex_triangles.h"

namespace limber {

namespace {

// Newton steps along the gradient; a vertex on the seam stays on it.
Vec3 ontoSurface(const Sculpture& sculpture, Vec3 point, int steps) {
  const bool seam = point.x() == 0;
  for (int i = 0; i < steps; ++i) {
    const double distance = sculpture.distance(point);
    Vec3 slope = sculpture.slope(point, distance);
    if (seam) slope.x() = 0;
    const double steepness = slope.squaredNorm();
    if (steepness < 1e-6) break;
    point -= slope * (distance / steepness);
  }
  return point;
}

double cotangent(const Vec3& apex, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - apex, v = b - apex;
  const double area = u.cross(v).norm();
  return area > 0 ? u.dot(v) / area : 1e9;
}

// Replaces each triangle by the parts that its marked edges cut it into. `middle` holds the new vertex of each marked
// edge, in the order of the corners that the edges start from.
void subdivide(HalfMesh& mesh, const std::vector<std::array<Index, 3>>& middle) {
  const std::vector<Triangle> triangles = std::move(mesh.triangles);
  const std::vector<int> materials = std::move(mesh.materials);
  mesh.triangles.clear();
  mesh.materials.clear();
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto emit = [&](Index a, Index b, Index c) {
      mesh.triangles.push_back({a, b, c});
      mesh.materials.push_back(materials[t]);
    };
    const Triangle& v = triangles[t];
    const std::array<Index, 3>& m = middle[t];
    const auto marked = std::count_if(m.begin(), m.end(), [](Index i) { return i != kNoIndex; });
    if (marked == 0) {
      emit(v[0], v[1], v[2]);
    } else if (marked == 3) {
      emit(v[0], m[0], m[2]);
      emit(v[1], m[1], m[0]);
      emit(v[2], m[2], m[1]);
      emit(m[0], m[1], m[2]);
    } else if (marked == 1) {
      const std::size_t i = m[0] != kNoIndex ? 0 : m[1] != kNoIndex ? 1 : 2;
      emit(v[i], m[i], v[(i + 2) % 3]);
      emit(m[i], v[(i + 1) % 3], v[(i + 2) % 3]);
    } else {
      // The corner between the two marked edges is cut off; the rest is split along its shorter diagonal.
      const std::size_t i = m[0] == kNoIndex ? 2 : m[1] == kNoIndex ? 0 : 1;  // edge i - 1 and edge i are marked
      const Index before = m[(i + 2) % 3], after = m[i], b = v[(i + 1) % 3], c = v[(i + 2) % 3];
      emit(v[i], after, before);
      const auto& p = mesh.positions;
      if ((p[after] - p[c]).squaredNorm() <= (p[before] - p[b]).squaredNorm()) {
        emit(after, b, c);
        emit(after, c, before);
      } else {
        emit(after, b, before);
        emit(b, c, before);
      }
    }
  }
}

// Calls split(a, b) once for each edge; where it returns a point, the edge is cut there. Returns how many were.
template <class Split>
int splitEdges(HalfMesh& mesh, const Split& split) {
  const EdgeGroups edges(mesh.triangles, static_cast<Index>(mesh.positions.size()));
  std::vector<std::array<Index, 3>> middle(mesh.triangles.size(), {kNoIndex, kNoIndex, kNoIndex});
  int count = 0;
  edges.forEachEdge([&](std::span<const Index> sides) {
    Vec3 point;
    if (!split(edges.low(sides[0]), edges.high(sides[0]), point)) return;
    const Index vertex = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(point);
    for (const Index side : sides) middle[side / 3][side % 3] = vertex;
    ++count;
  });
  if (count > 0) subdivide(mesh, middle);
  return count;
}

// Flips edges inside one material whose opposite angles add up to more than two right angles.
void flipToDelaunay(HalfMesh& mesh, int passes) {
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<Triangle> triangles = mesh.triangles;
    const EdgeGroups groups(triangles, static_cast<Index>(mesh.positions.size()));
    std::vector<std::pair<Index, Index>> edges;  // ascending
    groups.forEachEdge(
        [&](std::span<const Index> sides) { edges.emplace_back(groups.low(sides[0]), groups.high(sides[0])); });
    std::vector<char> touched(triangles.size(), 0);
    std::set<std::pair<Index, Index>> made;
    const auto flip = [&](Index side, Index otherSide) {
      const Index one = side / 3, other = otherSide / 3;
      if (touched[one] || touched[other] || mesh.materials[one] != mesh.materials[other]) return;
      const Index a = groups.corner(side), b = groups.corner(nextSide(side));
      const Index c = groups.corner(nextSide(nextSide(side))), d = groups.corner(nextSide(nextSide(otherSide)));
      const std::pair<Index, Index> edge = std::minmax(c, d);
      const auto& p = mesh.positions;
      if (cotangent(p[c], p[a], p[b]) + cotangent(p[d], p[a], p[b]) >= -0.02) return;
      if (std::binary_search(edges.begin(), edges.end(), edge)) return;
      if (p[c].x() == 0 && p[d].x() == 0) return;  // its mirror image would be the same edge again
      const Vec3 first = (p[d] - p[c]).cross(p[a] - p[c]), second = (p[b] - p[c]).cross(p[d] - p[c]);
      const Vec3 before = (p[b] - p[a]).cross(p[c] - p[a]);
      if (first.dot(before) <= 0 || second.dot(before) <= 0) return;  // it would fold over
      if (!made.insert(edge).second) return;
      touched[one] = touched[other] = 1;
      mesh.triangles[one] = {c, a, d};
      mesh.triangles[other] = {c, d, b};
    };
    groups.forEachEdge([&](std::span<const Index> sides) {
      for (std::size_t i = 1; i < sides.size(); ++i) flip(sides[i - 1], sides[i]);
    });
    if (made.empty()) break;
  }
}

// The length that edges at each vertex should have: `edge`, what the regions want, and no more than a small part of a
// turn where the surface is curved.
std::vector<double> wantedLengths(const HalfMesh& mesh, double edge, const std::vector<DetailRegion>& regions) {
  constexpr double kTurn = 0.5, kFinest = 0.45;  // radians for each edge; part of `edge`
  std::vector<Vec3> normals = areaNormals<Vec3>(mesh.positions, mesh.triangles);
  for (std::size_t v = 0; v < normals.size(); ++v) {
    if (mesh.positions[v].x() == 0) normals[v].x() = 0;
    normals[v].normalize();
  }
  std::vector<double> curvature(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = t[c], b = t[(c + 1) % 3];
      const double bend =
          (normals[a] - normals[b]).norm() / std::max(1e-9, (mesh.positions[a] - mesh.positions[b]).norm());
      curvature[a] = std::max(curvature[a], bend);
      curvature[b] = std::max(curvature[b], bend);
    }
  }
  std::vector<double> wanted(mesh.positions.size());
  for (std::size_t v = 0; v < wanted.size(); ++v) {
    wanted[v] = std::clamp(kTurn / std::max(curvature[v], 1e-9), kFinest * edge, edge);
    for (const DetailRegion& region : regions) {
      // Coarser again with the distance from the region, so that sizes change gently.
      wanted[v] = std::min(wanted[v], region.edge + 0.4 * std::max(0.0, region.where.distance(mesh.positions[v])));
    }
  }
  return wanted;
}

// Takes out vertices that were merged into another, and the triangles that this closed.
void dropMerged(HalfMesh& mesh, const std::vector<Index>& target) {
  std::vector<Index> number(mesh.positions.size(), kNoIndex);
  std::size_t kept = 0;
  for (std::size_t v = 0; v < target.size(); ++v) {
    if (target[v] != v) continue;
    number[v] = static_cast<Index>(kept);
    mesh.positions[kept++] = mesh.positions[v];
  }
  mesh.positions.resize(kept);
  std::size_t out = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Triangle v = mesh.triangles[t];
    for (Index& corner : v) corner = number[target[corner]];
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    mesh.triangles[out] = v;
    mesh.materials[out++] = mesh.materials[t];
  }
  mesh.triangles.resize(out);
  mesh.materials.resize(out);
}

// May `gone` be merged into `kept` at `point`? Not where the surface would pinch (the link condition of Dey et al.
// 1999), fold, or get triangles that are much too long.
bool mayCollapse(const HalfMesh& mesh, const Grouped<Index>& trianglesAt, Index kept, Index gone, std::size_t triangles,
                 const Vec3& point, double longest) {
  const std::vector<Index> around = neighboursOf(kept, mesh.triangles, trianglesAt);
  const std::vector<Index> other = neighboursOf(gone, mesh.triangles, trianglesAt);
  std::vector<Index> common;
  std::set_intersection(around.begin(), around.end(), other.begin(), other.end(), std::back_inserter(common));
  if (common.size() != triangles || around.size() + other.size() < 7 + triangles) return false;
  // Two vertices of the seam must not get an edge through the inside.
  if (mesh.positions[kept].x() == 0 && mesh.positions[gone].x() != 0) {
    for (const Index v : other) {
      if (v != kept && mesh.positions[v].x() == 0 && !std::binary_search(around.begin(), around.end(), v)) return false;
    }
  }
  for (const Index vertex : {kept, gone}) {
    for (const Index t : trianglesAt.of(vertex)) {
      const Triangle& v = mesh.triangles[t];
      const auto has = [&](Index wanted) { return std::find(v.begin(), v.end(), wanted) != v.end(); };
      if (has(kept) && has(gone)) continue;
      std::array<Vec3, 3> before, after;
      for (std::size_t c = 0; c < 3; ++c) {
        before[c] = mesh.positions[v[c]];
        after[c] = v[c] == vertex ? point : before[c];
        if (v[c] != vertex && (point - before[c]).norm() > longest) return false;
      }
      const Vec3 was = (before[1] - before[0]).cross(before[2] - before[0]);
      const Vec3 is = (after[1] - after[0]).cross(after[2] - after[0]);
      if (was.dot(is) < 0.5 * was.norm() * is.norm()) return false;
    }
  }
  return true;
}

// Merges the ends of edges that are much shorter than wanted, shortest first, no two of them close to each other.
// Returns whether it may be worth calling again.
bool collapseShortEdges(HalfMesh& mesh, const Sculpture& sculpture, const std::vector<double>& wanted) {
  struct Candidate {
    double length;
    Index kept, gone;
    std::size_t triangles;
  };
  const EdgeGroups edges(mesh.triangles, static_cast<Index>(mesh.positions.size()));
  std::vector<Candidate> candidates;
  edges.forEachEdge([&](std::span<const Index> sides) {
    const Index low = edges.low(sides[0]), high = edges.high(sides[0]);
    const double length = (mesh.positions[low] - mesh.positions[high]).norm();
    if (!(length < 0.72 * std::min(wanted[low], wanted[high]))) return;
    Candidate candidate{length, low, high, sides.size()};
    if (mesh.positions[high].x() == 0) std::swap(candidate.kept, candidate.gone);  // the seam's vertex stays
    candidates.push_back(candidate);
  });
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.length, a.kept, a.gone) < std::tie(b.length, b.kept, b.gone);
  });

  const Grouped<Index> trianglesAt = trianglesAtVertices(mesh.triangles, mesh.positions.size());
  std::vector<char> touched(mesh.positions.size(), 0);
  std::vector<Index> target(mesh.positions.size());
  std::iota(target.begin(), target.end(), Index{0});
  int count = 0;
  for (const Candidate& c : candidates) {
    const bool seamKept = mesh.positions[c.kept].x() == 0, seamGone = mesh.positions[c.gone].x() == 0;
    if (touched[c.kept] || touched[c.gone] || (seamKept && seamGone && c.triangles != 1)) continue;
    Vec3 point = mesh.positions[c.kept];
    if (seamKept == seamGone) point = ontoSurface(sculpture, 0.5 * (point + mesh.positions[c.gone]), 1);
    if (!mayCollapse(mesh, trianglesAt, c.kept, c.gone, c.triangles, point,
                     1.35 * std::min(wanted[c.kept], wanted[c.gone])))
      continue;
    for (const Index vertex : {c.kept, c.gone}) {
      for (const Index t : trianglesAt.of(vertex)) {
        for (const Index v : mesh.triangles[t]) touched[v] = 1;
      }
    }
    mesh.positions[c.kept] = point;
    target[c.gone] = c.kept;
    ++count;
  }
  if (count > 0) dropMerged(mesh, target);
  return count * 50 > static_cast<int>(mesh.positions.size());
}

}  // namespace

void relax(HalfMesh& mesh, const Sculpture& sculpture, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    // On the seam the mirrored neighbours count as well: they double each inner neighbour, as counting by triangles
    // does already.
    std::vector<Vec3> sum(mesh.positions.size(), Vec3::Zero());
    std::vector<double> count(mesh.positions.size(), 0);
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Index a = t[c], b = t[(c + 1) % 3];
        sum[a] += mesh.positions[b];
        sum[b] += mesh.positions[a];
        count[a] += 1;
        count[b] += 1;
      }
    }
    parallelFor(mesh.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        if (count[v] == 0) continue;
        Vec3& p = mesh.positions[v];
        const bool seam = p.x() == 0;
        Vec3 move = 0.6 * (sum[v] / count[v] - p);
        Vec3 slope = sculpture.slope(p, sculpture.distance(p));
        if (seam) slope.x() = move.x() = 0;
        const double steepness = slope.squaredNorm();
        if (steepness < 1e-6) continue;
        move -= slope * (slope.dot(move) / steepness);
        p += move;
        p -= slope * (sculpture.distance(p) / steepness);  // the slope has hardly changed over so short a distance
        if (!seam) p.x() = std::max(p.x(), 1e-6);
      }
    });
  }
}

void remesh(HalfMesh& mesh, const Sculpture& sculpture, double edge, const std::vector<DetailRegion>& regions) {
  for (int pass = 0; pass < 5; ++pass) {
    const std::vector<double> wanted = wantedLengths(mesh, edge, regions);
    splitEdges(mesh, [&](Index a, Index b, Vec3& point) {
      const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
      if ((p - q).norm() < 1.4 * std::min(wanted[a], wanted[b])) return false;
      point = ontoSurface(sculpture, 0.5 * (p + q), 2);
      return true;
    });
    while (collapseShortEdges(mesh, sculpture, wantedLengths(mesh, edge, regions))) {
    }
    flipToDelaunay(mesh, 4);
    relax(mesh, sculpture, 2);
  }
  flipToDelaunay(mesh, 4);
  relax(mesh, sculpture, 2);
}

void paint(HalfMesh& mesh, const Sculpture& sculpture, const Solid& region, int material) {
  constexpr double kSnap = 0.3;  // of an edge: a vertex that near the border is moved onto it
  const Vec3 across(-1, 1, 1);
  const auto level = [&](const Vec3& p) {
    return std::min(region.distance(p), region.distance(p.cwiseProduct(across)));
  };
  std::vector<double> shortest(mesh.positions.size(), 1e30), levels(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Index a = t[c], b = t[(c + 1) % 3];
      const double length = (mesh.positions[a] - mesh.positions[b]).norm();
      shortest[a] = std::min(shortest[a], length);
      shortest[b] = std::min(shortest[b], length);
    }
  }
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    levels[v] = level(p);
    if (std::abs(levels[v]) > kSnap * shortest[v]) continue;
    const Vec3 normal = sculpture.gradient(p).normalized();
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = 1e-4 * Vec3::Unit(axis);
      slope[axis] = (level(p + step) - level(p - step)) / 2e-4;
    }
    slope -= normal * normal.dot(slope);
    if (p.x() == 0) slope.x() = 0;
    if (slope.squaredNorm() < 0.04) continue;  // the border runs along the surface here
    const bool seam = p.x() == 0;
    p = ontoSurface(sculpture, p - slope * (levels[v] / slope.squaredNorm()), 1);
    if (!seam) p.x() = std::max(p.x(), 1e-6);
    levels[v] = 0;
  }
  splitEdges(mesh, [&](Index a, Index b, Vec3& point) {
    if (levels[a] * levels[b] >= 0) return false;
    const double t = levels[a] / (levels[a] - levels[b]);
    point = ontoSurface(sculpture, (1 - t) * mesh.positions[a] + t * mesh.positions[b], 1);
    return true;
  });
  levels.resize(mesh.positions.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& v = mesh.triangles[t];
    if (levels[v[0]] + levels[v[1]] + levels[v[2]] < 0) mesh.materials[t] = material;
  }
  flipToDelaunay(mesh, 2);
}

SymmetricMesh mirrorHalf(const HalfMesh& half, const Sculpture& sculpture) {
  SymmetricMesh mesh;
  std::vector<Index> twin(half.positions.size());
  std::vector<Vec3f> normals(half.positions.size());
  parallelFor(half.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3 normal = sculpture.gradient(half.positions[v]);
      if (half.positions[v].x() == 0) normal.x() = 0;
      normals[v] = normal.normalized().cast<float>();
    }
  });
  for (const Vec3& p : half.positions) mesh.positions.push_back(p.cast<float>());
  mesh.normals = normals;
  const Vec3f across(-1, 1, 1);
  for (Index v = 0; v < half.positions.size(); ++v) {
    twin[v] = v;
    if (half.positions[v].x() == 0) continue;
    twin[v] = static_cast<Index>(mesh.positions.size());
    mesh.positions.push_back(mesh.positions[v].cwiseProduct(across));
    mesh.normals.push_back(normals[v].cwiseProduct(across));
  }
  mesh.triangles = half.triangles;
  mesh.materials = half.materials;
  for (std::size_t t = 0; t < half.triangles.size(); ++t) {
    const Triangle& v = half.triangles[t];
    mesh.triangles.push_back({twin[v[0]], twin[v[2]], twin[v[1]]});
    mesh.materials.push_back(half.materials[t]);
  }
  return mesh;
}

}  // namespace limber
