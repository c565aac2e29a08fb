// Meshes made in code for tests: a catalogue by property, and the shapes it is put together from. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

inline TriMesh join(TriMesh a, const TriMesh& b) {
  const Index offset = a.vertexCount();
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

inline TriMesh moved(TriMesh mesh, const Vec3f& scale, const Vec3f& offset) {
  for (Vec3f& p : mesh.positions) p = p.cwiseProduct(scale) + offset;
  return mesh;
}

// Each triangle cut in four, as flat as it was; further vertices come behind those there were.
inline TriMesh cutInFour(const TriMesh& mesh) {
  TriMesh result;
  result.positions = mesh.positions;
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), result.vertexCount());
    if (fresh) result.positions.push_back(0.5f * (result.positions[a] + result.positions[b]));
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    result.triangles.insert(result.triangles.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return result;
}

// A sphere of radius 1, each level four times the triangles of the one before, from 20. Mirror symmetric in x, y and z.
inline TriMesh icosphere(int level) {
  const float g = (1 + std::sqrt(5.0f)) / 2;
  TriMesh mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (Vec3f& p : mesh.positions) p.normalize();
  for (int i = 0; i < level; ++i) {
    const auto known = static_cast<std::ptrdiff_t>(mesh.positions.size());
    mesh = cutInFour(mesh);
    std::for_each(mesh.positions.begin() + known, mesh.positions.end(), [](Vec3f& p) { p.normalize(); });
  }
  return mesh;
}

// columns x rows squares in the unit square of the plane z = 0, each split in two. `shake` moves inner vertices by up
// to that part of a square, which makes some edges not Delaunay.
inline TriMesh flatGrid(int columns, int rows, float shake = 0) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> offset(-shake, shake);
  TriMesh mesh;
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      const bool inner = i > 0 && j > 0 && i < columns && j < rows;
      const float dx = inner ? offset(random) : 0, dy = inner ? offset(random) : 0;
      const float x = static_cast<float>(i) + dx, y = static_cast<float>(j) + dy;
      mesh.positions.push_back({x / static_cast<float>(columns), y / static_cast<float>(rows), 0});
    }
  }
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Index a = static_cast<Index>(j * (columns + 1) + i), b = a + 1;
      const Index c = a + static_cast<Index>(columns) + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

// A tube of radius 0.1 about the x axis from -0.5 to 0.5, mirror symmetric in x; closed by fans where `capped`.
inline TriMesh tube(int around, int rings, bool capped) {
  TriMesh mesh;
  const auto at = [&](int ring, int i) { return static_cast<Index>(ring * around + (i % around)); };
  for (int ring = 0; ring < rings; ++ring) {
    const float x = static_cast<float>(ring) / static_cast<float>(rings - 1) - 0.5f;
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * kPi * i / around;
      mesh.positions.push_back(
          {x, static_cast<float>(0.1 * std::cos(angle)), static_cast<float>(0.1 * std::sin(angle))});
    }
  }
  for (int ring = 0; ring + 1 < rings; ++ring) {
    for (int i = 0; i < around; ++i) {
      const Index a = at(ring, i), b = at(ring, i + 1), c = at(ring + 1, i), d = at(ring + 1, i + 1);
      if (2 * ring + 1 < rings - 1) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {b, d, c}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
      }
    }
  }
  if (!capped) return mesh;
  const Index first = mesh.vertexCount(), last = first + 1;
  mesh.positions.push_back({-0.5f, 0, 0});
  mesh.positions.push_back({0.5f, 0, 0});
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({first, at(0, i + 1), at(0, i)});
    mesh.triangles.push_back({last, at(rings - 1, i), at(rings - 1, i + 1)});
  }
  return mesh;
}

// `count` rectangles that meet along one edge, each split in a few triangles.
inline TriMesh pages(int count) {
  TriMesh mesh;
  mesh.positions = {{0, 0, -0.5f}, {0, 0, 0}, {0, 0, 0.5f}};
  for (int page = 0; page < count; ++page) {
    const double angle = 2 * kPi * page / count + 0.1;
    const Index first = mesh.vertexCount();
    for (const float z : {-0.5f, 0.0f, 0.5f}) {
      mesh.positions.push_back(
          {static_cast<float>(0.5 * std::cos(angle)), static_cast<float>(0.5 * std::sin(angle)), z});
    }
    for (Index k = 0; k < 2; ++k) {
      const Triangle lower = {k, first + k, k + 1}, upper = {k + 1, first + k, first + k + 1};
      mesh.triangles.push_back(lower);
      mesh.triangles.push_back(page % 2 ? Triangle{upper[0], upper[2], upper[1]} : upper);  // alternating sides
    }
  }
  return mesh;
}

// Triangles between `vertices` random points, which share edges and vertices at random and cross each other.
inline TriMesh soup(Index vertices, Index triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-0.5f, 0.5f);
  TriMesh mesh;
  for (Index v = 0; v < vertices; ++v) {
    mesh.positions.push_back({coordinate(random), coordinate(random), coordinate(random)});
  }
  const auto pick = [&] { return static_cast<Index>(random() % vertices); };
  while (mesh.triangleCount() < triangles) {
    const Triangle t = {pick(), pick(), pick()};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

inline TriMesh moebius(int segments) {
  TriMesh mesh;
  for (int i = 0; i < segments; ++i) {
    const double turn = 2 * kPi * i / segments;
    for (const double side : {-0.15, 0.0, 0.15}) {
      const double radius = 0.35 + side * std::cos(turn / 2);
      mesh.positions.push_back({static_cast<float>(radius * std::cos(turn)),
                                static_cast<float>(radius * std::sin(turn)),
                                static_cast<float>(side * std::sin(turn / 2))});
    }
  }
  for (int i = 0; i < segments; ++i) {
    const bool seam = i + 1 == segments;
    const Index here = static_cast<Index>(3 * i), next = seam ? 0 : here + 3;
    for (Index k = 0; k < 2; ++k) {
      const Index a = here + k, b = a + 1;
      const Index c = seam ? next + 2 - k : next + k, d = seam ? next + 1 - k : next + k + 1;
      mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
    }
  }
  return mesh;
}

// A grid whose middle row is squeezed into slivers: zero area, zero height or 1e-7 of an edge.
inline TriMesh sliveredGrid() {
  TriMesh mesh = flatGrid(6, 6);
  for (int i = 0; i <= 6; ++i) {
    mesh.positions[3 * 7 + i].y() = mesh.positions[2 * 7 + i].y() + (i % 3 == 0 ? 0.0f : i % 3 == 1 ? 1e-7f : 1e-3f);
  }
  mesh.triangles.push_back({0, 1, 2});    // three in a line
  mesh.triangles.push_back({0, 1, 2});    // and once more
  mesh.triangles.push_back({14, 21, 7});  // with two corners at one position
  return mesh;
}

struct NamedMesh {
  std::string name;
  TriMesh mesh;

  friend std::ostream& operator<<(std::ostream& out, const NamedMesh& named) { return out << named.name; }
};

// Names the instances of a test over the catalogue.
struct MeshName {
  template <class TestInfo>
  std::string operator()(const TestInfo& info) const {
    std::string name = info.param.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return name;
  }
};

// One of every kind, with a longest side of about 1.
inline std::vector<NamedMesh> catalogue() {
  const TriMesh ball = moved(icosphere(2), Vec3f::Constant(0.5f), Vec3f::Zero());
  TriMesh flipped = ball;
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 3)
    std::swap(flipped.triangles[t][0], flipped.triangles[t][1]);
  TriMesh doubled = ball;
  doubled.triangles.insert(doubled.triangles.end(), ball.triangles.begin(), ball.triangles.begin() + 40);
  TriMesh loose = flatGrid(4, 4, 0.3f);
  loose.positions.push_back({0.2f, 0.2f, 0.4f});
  TriMesh pieces;
  for (int i = 0; i < 30; ++i) {
    const float x = static_cast<float>(i % 6) / 6, y = static_cast<float>(i / 6) / 6;
    pieces = join(pieces, moved(icosphere(i % 3 == 0 ? 1 : 0), Vec3f::Constant(0.08f), {x - 0.5f, y - 0.4f, 0}));
  }
  TriMesh bowTie = join(flatGrid(2, 2), moved(flatGrid(2, 2), Vec3f::Ones(), {1, 1, 0}));
  for (Triangle& t : bowTie.triangles) {
    for (Index& v : t) v = v == 9 ? 8 : v;  // the corner at (1, 1) becomes one vertex
  }
  return {{"closed", ball},
          {"capped tube", tube(12, 15, true)},
          {"open tube", tube(12, 15, false)},
          {"flat grid", flatGrid(8, 5)},
          {"shaken grid", flatGrid(9, 9, 0.45f)},
          {"faces the wrong way", flipped},
          {"doubled faces", doubled},
          {"one triangle", TriMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
          {"three at an edge", pages(3)},
          {"seven at an edge", pages(7)},
          {"moebius", moebius(24)},
          {"touching at a vertex", bowTie},
          {"slivers", sliveredGrid()},
          {"isolated vertex", loose},
          {"many pieces", pieces},
          {"crossing", join(ball, moved(ball, Vec3f::Ones(), {0.3f, 0.1f, 0}))},
          {"soup", soup(40, 120, 3)},
          {"loose triangles", soup(300, 60, 5)}};
}

}  // namespace limber::testing
