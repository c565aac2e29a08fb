// Small meshes made in code, for tests: closed, open, broken, in pieces, symmetric or not.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// The same numbers on every machine, in [0, 1).
class TestRandom {
 public:
  explicit TestRandom(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
  std::uint32_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return static_cast<std::uint32_t>(state_ >> 16);
  }
  double unit() { return bits() / 4294967296.0; }
  Index below(Index count) { return bits() % count; }

 private:
  std::uint64_t state_;
};

inline TriMesh joined(const TriMesh& a, const TriMesh& b, const Vec3f& offset = Vec3f::Zero()) {
  TriMesh mesh = a;
  for (const Vec3f& p : b.positions) mesh.positions.push_back(p + offset);
  for (const Triangle& t : b.triangles) {
    mesh.triangles.push_back({t[0] + a.vertexCount(), t[1] + a.vertexCount(), t[2] + a.vertexCount()});
  }
  return mesh;
}

// Every triangle into four; `toUnitSphere` moves all vertices there.
inline TriMesh subdivided(const TriMesh& mesh, bool toUnitSphere = false) {
  TriMesh result;
  result.positions = mesh.positions;
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middle = [&](Index a, Index b) {
    const auto [it, isNew] = middles.try_emplace({std::min(a, b), std::max(a, b)}, result.vertexCount());
    if (isNew) result.positions.push_back(0.5f * (mesh.positions[a] + mesh.positions[b]));
    return it->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
      result.triangles.push_back(t);
    }
  }
  if (toUnitSphere) {
    for (Vec3f& p : result.positions) p.normalize();
  }
  return result;
}

inline TriMesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

inline TriMesh ball(int subdivisions) {
  TriMesh mesh = octahedron();
  for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh, true);
  return mesh;
}

// columns x rows squares in the plane z = 0, of side 1.
inline TriMesh flatGrid(Index columns, Index rows) {
  TriMesh mesh;
  for (Index y = 0; y <= rows; ++y) {
    for (Index x = 0; x <= columns; ++x) mesh.positions.push_back({static_cast<float>(x), static_cast<float>(y), 0});
  }
  for (Index y = 0; y < rows; ++y) {
    for (Index x = 0; x < columns; ++x) {
      const Index a = y * (columns + 1) + x, b = a + 1, c = a + columns + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  }
  return mesh;
}

// The outside of a set of unit cubes, each given by its least corner; two triangles a side, vertices shared.
inline TriMesh cubes(const std::set<std::array<int, 3>>& cells) {
  TriMesh mesh;
  std::map<std::array<int, 3>, Index> vertices;
  const auto vertex = [&](const std::array<int, 3>& corner) {
    const auto [it, isNew] = vertices.try_emplace(corner, mesh.vertexCount());
    if (isNew) mesh.positions.push_back(Vec3f(corner[0], corner[1], corner[2]));
    return it->second;
  };
  for (const auto& cell : cells) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        auto beyond = cell;
        beyond[axis] += side == 1 ? 1 : -1;
        if (cells.count(beyond)) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<Index, 4> ring{};
        for (int i = 0; i < 4; ++i) {
          auto corner = cell;
          corner[axis] += side;
          corner[u] += i == 1 || i == 2;
          corner[v] += i >= 2;
          ring[i] = vertex(corner);
        }
        if (side == 0) std::swap(ring[1], ring[3]);
        mesh.triangles.push_back({ring[0], ring[1], ring[2]});
        mesh.triangles.push_back({ring[0], ring[2], ring[3]});
      }
    }
  }
  return mesh;
}

// A creature of cubes, its own image in x: trunk, head, two arms, two legs. About 10 high, 11 wide.
inline TriMesh blockBiped(int subdivisions = 0) {
  std::set<std::array<int, 3>> cells;
  const auto fill = [&](int x0, int x1, int y0, int y1) {
    for (int x = x0; x < x1; ++x) {
      for (int y = y0; y < y1; ++y) cells.insert({x, y, 0});
    }
  };
  fill(-2, 2, 4, 8);   // trunk
  fill(-1, 1, 8, 10);  // head
  fill(-6, -2, 7, 8);  // arms
  fill(2, 6, 7, 8);
  fill(-2, -1, -1, 4);  // legs
  fill(1, 2, -1, 4);
  TriMesh mesh = cubes(cells);
  for (int i = 0; i < subdivisions; ++i) mesh = subdivided(mesh);
  for (Vec3f& p : mesh.positions) p.z() -= 0.5f;
  return mesh;
}

// No triangle shares a vertex with another.
inline TriMesh soupOf(const TriMesh& mesh) {
  TriMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const Index first = soup.vertexCount();
    for (const Index v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

// Every vertex moved by up to `amount` in each direction: no symmetry, no two errors alike.
inline TriMesh jittered(TriMesh mesh, float amount, std::uint64_t seed = 1) {
  TestRandom random(seed);
  for (Vec3f& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) p[i] += amount * static_cast<float>(2 * random.unit() - 1);
  }
  return mesh;
}

// Vertices in another order.
inline TriMesh shuffled(const TriMesh& mesh, std::uint64_t seed = 1) {
  TestRandom random(seed);
  std::vector<Index> indices(mesh.positions.size());
  for (Index i = 0; i < indices.size(); ++i) indices[i] = i;
  for (Index i = mesh.vertexCount(); i > 1; --i) std::swap(indices[i - 1], indices[random.below(i)]);
  TriMesh result = mesh;
  for (Index i = 0; i < indices.size(); ++i) result.positions[indices[i]] = mesh.positions[i];
  for (Triangle& t : result.triangles) {
    for (Index& v : t) v = indices[v];
  }
  return result;
}

struct NamedMesh {
  std::string name;
  TriMesh mesh;
};

// One of each kind of trouble.
inline std::vector<NamedMesh> meshCatalogue() {
  TriMesh fins = ball(2);  // three triangles at some edges
  for (Index t = 0; t < 6; ++t) {
    const Triangle triangle = fins.triangles[10 * t];
    fins.positions.push_back(1.5f * fins.positions[triangle[0]]);
    fins.triangles.push_back({triangle[0], triangle[1], fins.vertexCount() - 1});
  }
  TriMesh zeroArea = flatGrid(4, 4);
  zeroArea.triangles.push_back({0, 1, 2});
  zeroArea.triangles.push_back({3, 3, 4});
  TriMesh isolated = ball(1);
  for (int i = 0; i < 5; ++i) isolated.positions.push_back({2.0f + static_cast<float>(i), 0.5f, 0});
  TriMesh opened = ball(2);
  opened.triangles.resize(opened.triangles.size() / 2);
  TriMesh flipped = jittered(ball(2), 0.05f);
  for (std::size_t t = 0; t < flipped.triangles.size(); t += 3)
    std::swap(flipped.triangles[t][1], flipped.triangles[t][2]);
  TriMesh confetti;
  TestRandom random(3);
  for (int i = 0; i < 60; ++i) {
    const auto positionOf = [&] { return static_cast<float>(10 * random.unit()); };
    confetti = joined(confetti, jittered({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 0.3f, 100 + i),
                      {positionOf(), positionOf(), positionOf()});
  }
  TriMesh fan;  // one vertex with 200 neighbours
  fan.positions.push_back({0, 0, 0.3f});
  for (int i = 0; i < 200; ++i) {
    const float angle = static_cast<float>(i) * 0.031416f;
    fan.positions.push_back({std::cos(angle), std::sin(angle), 0});
    fan.triangles.push_back({0, static_cast<Index>(1 + i), static_cast<Index>(1 + (i + 1) % 200)});
  }
  return {{"octahedron", octahedron()},
          {"ball", jittered(ball(2), 0.05f)},
          {"symmetric ball", ball(2)},
          {"open", opened},
          {"fins", fins},
          {"soup", soupOf(ball(1))},
          {"confetti", confetti},
          {"zero area", zeroArea},
          {"nothing but zero area", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {1, 2, 3}}}},
          {"all at one point", {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}},
          {"isolated vertices", isolated},
          {"points alone", {{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, {}}},
          {"one vertex", {{{3, 2, 1}}, {}}},
          {"one triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
          {"flat grid", flatGrid(9, 6)},
          {"two far apart", joined(ball(1), octahedron(), {300, 0, 0})},
          {"flipped triangles", flipped},
          {"fan", fan},
          {"biped", blockBiped()},
          {"fine biped", shuffled(blockBiped(1))}};
}

}  // namespace limber::testing
