#include "limber/geometry/surface/surface_edges.h"

#include <set>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

TEST(SurfaceEdges, EachEdgeOnceInOrder) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    std::set<VertexPair> expected;
    for (const Triangle& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        const Index a = t[i], b = t[(i + 1) % 3];
        if (a != b) expected.insert({std::min(a, b), std::max(a, b)});
      }
    }
    const std::vector<VertexPair> edges = surfaceEdges(mesh).edges;
    EXPECT_EQ(edges, std::vector<VertexPair>(expected.begin(), expected.end())) << name;
  }
}

// Every triangle of a ball faces outwards after the turn, whatever was flipped before.
void expectOutwards(const TriMesh& mesh) {
  const SurfaceEdges surface = surfaceEdges(mesh);
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 normal = (mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a));
    EXPECT_GT(surface.facing[t] * normal.dot(mesh.position(a)), 0) << t;
  }
}

TEST(SurfaceEdges, FlippedTrianglesAreTurnedOutwards) {
  const TriMesh ball = testing::ball(2);
  expectOutwards(ball);
  for (const std::size_t every : {1u, 2u, 3u, 7u}) {
    TriMesh flipped = ball;
    for (std::size_t t = 0; t < flipped.triangles.size(); t += every) {
      std::swap(flipped.triangles[t][1], flipped.triangles[t][2]);
    }
    expectOutwards(flipped);
  }
}

TEST(SurfaceEdges, EachPieceForItself) {
  TriMesh inner = testing::ball(1);
  for (Triangle& t : inner.triangles) std::swap(t[0], t[1]);
  const TriMesh two = testing::joined(testing::ball(1), inner, {5, 0, 0});
  const std::vector<std::int8_t> facing = surfaceEdges(two).facing;
  for (std::size_t t = 0; t < facing.size(); ++t) EXPECT_EQ(facing[t], t < facing.size() / 2 ? 1 : -1);
}

TEST(SurfaceEdges, HalfABallFacesAsTheWholeDid) {
  TriMesh open = testing::ball(2);
  open.triangles.erase(std::remove_if(open.triangles.begin(), open.triangles.end(),
                                      [&](const Triangle& t) { return open.positions[t[0]].y() > 0.3f; }),
                       open.triangles.end());
  expectOutwards(open);
  for (Triangle& t : open.triangles) std::swap(t[0], t[1]);
  expectOutwards(open);
}

TEST(SurfaceEdges, AFlatSheetFacesAsMostOfItDoes) {
  TriMesh sheet = testing::flatGrid(5, 5);
  for (int t = 0; t < 10; ++t) std::swap(sheet.triangles[3 * t][0], sheet.triangles[3 * t][1]);
  const std::vector<std::int8_t> facing = surfaceEdges(sheet).facing;
  for (int t = 0; t < 50; ++t) EXPECT_EQ(facing[t], t % 3 == 0 && t < 30 ? -1 : 1) << t;
}

}  // namespace

}  // namespace limber
