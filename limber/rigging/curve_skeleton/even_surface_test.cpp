#include "limber/rigging/curve_skeleton/even_surface.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/core/disjoint_sets.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

EvenSurface evenOf(const TriMesh& mesh, bool isMirrored, Index most = kMaxEvenPoints) {
  const std::optional<MirrorPlane> plane = isMirrored ? std::optional<MirrorPlane>(MirrorPlane{}) : std::nullopt;
  return evenSurface(mesh, CollapseFrame::of(mesh, plane), isMirrored, most);
}

double totalArea(const EvenSurface& surface) {
  double sum = 0;
  for (const double area : surface.areas) sum += area;
  return sum;
}

// In longest sides squared.
double areaOfMesh(const TriMesh& mesh) {
  const CollapseFrame frame = CollapseFrame::of(mesh, std::nullopt);
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += 0.5 * (mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a)).norm();
  }
  return sum / frame.scale / frame.scale;
}

std::size_t piecesOf(std::size_t points, const std::vector<VertexPair>& edges) {
  DisjointSets sets(points);
  for (const auto& [a, b] : edges) sets.unite(a, b);
  return sets.count();
}

void expectSound(const EvenSurface& surface) {
  const std::size_t points = surface.points.size();
  ASSERT_EQ(surface.areas.size(), points);
  ASSERT_EQ(surface.onPlane.size(), points);
  const std::set<VertexPair> edges(surface.edges.begin(), surface.edges.end());
  EXPECT_EQ(edges.size(), surface.edges.size());
  std::set<Triangle> met;
  for (Triangle t : surface.triangles) {
    std::sort(t.begin(), t.end());
    EXPECT_TRUE(t[0] < t[1] && t[1] < t[2] && t[2] < points);
    met.insert(t);
    for (const VertexPair& edge : {VertexPair{t[0], t[1]}, VertexPair{t[1], t[2]}, VertexPair{t[0], t[2]}}) {
      EXPECT_TRUE(edges.count(edge));
    }
  }
  for (std::size_t p = 0; p < points; ++p) {
    EXPECT_TRUE(surface.points[p].allFinite());
    EXPECT_GE(surface.areas[p], 0);
    if (surface.isHalf) {
      EXPECT_EQ(surface.onPlane[p] != 0, surface.points[p].x() == 0);
      EXPECT_GE(surface.points[p].x(), 0);
    } else {
      EXPECT_FALSE(surface.onPlane[p]);
    }
  }
}

bool isClosed(const TriMesh& mesh) {
  const EdgeGroups groups(mesh.triangles, mesh.vertexCount());
  bool closed = true;
  groups.forEachEdge([&](std::span<const Index> sides) { closed = closed && sides.size() > 1; });
  return closed;
}

TEST(EvenSurface, KeepsTheAreaAndClosesHoles) {
  for (auto [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1]; });
    const EvenSurface surface = evenOf(mesh, false);
    expectSound(surface);
    const double before = areaOfMesh(mesh), after = totalArea(surface);
    if (isClosed(mesh)) {
      EXPECT_NEAR(after, before, 1e-5 * before);
    } else {
      EXPECT_GE(after, before * (1 - 1e-5));
    }
  }
}

TEST(EvenSurface, AHoleIsClosedThroughItsMiddle) {
  // A box without its lid.
  TriMesh box = testing::cubes({{0, 0, 0}});
  std::erase_if(box.triangles, [&](const Triangle& t) {
    return box.positions[t[0]].z() == 1 && box.positions[t[1]].z() == 1 && box.positions[t[2]].z() == 1;
  });
  ASSERT_EQ(box.triangles.size(), 10u);
  EXPECT_NEAR(totalArea(evenOf(box, false)), 6, 1e-6);
}

TEST(EvenSurface, TheHalfOfASymmetricModelIsHalfOfIt) {
  for (const TriMesh& mesh : {testing::blockBiped(1), testing::ball(3), testing::cubes({{{-1, 0, 0}, {0, 0, 0}}})}) {
    const EvenSurface half = evenOf(mesh, true);
    expectSound(half);
    EXPECT_NEAR(totalArea(half), 0.5 * areaOfMesh(mesh), 1e-5);
    const UnfoldedSurface whole = unfolded(half);
    for (std::size_t p = 0; p < half.points.size(); ++p) {
      const Vec3f image = whole.mesh.positions[whole.image[p]];
      EXPECT_EQ(Vec3f(-image.x(), image.y(), image.z()), whole.mesh.positions[p]);
    }
  }
}

TEST(EvenSurface, CutsEdgesAtThePlaneWhereNoVertexLies) {
  // One cube about the plane: none of its vertices is on it.
  TriMesh cube = testing::cubes({{0, 0, 0}});
  for (Vec3f& p : cube.positions) p.x() -= 0.5f;
  const EvenSurface half = evenOf(cube, true, 100);
  expectSound(half);
  EXPECT_NEAR(totalArea(half), 3, 1e-6);
  EXPECT_GT(std::count(half.onPlane.begin(), half.onPlane.end(), 1), 3);
}

TEST(EvenSurface, HasNoMorePointsThanAskedForOfOnePiece) {
  const TriMesh mesh = testing::jittered(testing::ball(5), 0.01f);
  for (const Index most : {200u, 1000u, 4000u}) {
    const EvenSurface surface = evenOf(mesh, false, most);
    expectSound(surface);
    EXPECT_LE(surface.points.size(), most);
    EXPECT_GE(surface.points.size(), most / 4);
    EXPECT_EQ(piecesOf(surface.points.size(), surface.edges), 1u);
  }
}

TEST(EvenSurface, WhatIsApartStaysApart) {
  // Two sheets nearer to each other than points are apart.
  const TriMesh sheet = testing::flatGrid(60, 60);
  const EvenSurface surface = evenOf(testing::joined(sheet, sheet, {0, 0, 0.01f}), false, 500);
  EXPECT_LE(surface.points.size(), 500u);
  EXPECT_EQ(piecesOf(surface.points.size(), surface.edges), 2u);
}

TEST(EvenSurface, SplitsLongEdges) {
  const TriMesh mesh = testing::cubes({{0, 0, 0}});
  const EvenSurface surface = evenOf(mesh, false, 1000);
  EXPECT_GT(surface.points.size(), 300u);
  for (const auto& [a, b] : surface.edges) EXPECT_LT((surface.points[a] - surface.points[b]).norm(), 0.2);
}

}  // namespace

}  // namespace limber
