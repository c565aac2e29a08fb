#include "limber/geometry/surface/border_lengths.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

TEST(BorderLengths, RunFromTheMiddleOfAnEdgeToTheMiddlesOfItsTriangles) {
  TriMesh square;
  square.positions = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}};
  square.triangles = {{0, 1, 2}, {2, 3, 0}};
  const std::vector<VertexPair> edges = surfaceEdges(square).edges;
  const std::vector<double> lengths = borderLengths(square.positions, square.triangles, edges);
  ASSERT_EQ(edges.size(), 5u);
  for (std::size_t e = 0; e < 5; ++e) {
    const bool isDiagonal = edges[e] == VertexPair{0, 2};
    EXPECT_NEAR(lengths[e], isDiagonal ? 2 * std::sqrt(0.5) : std::sqrt(1.25), 1e-6);
  }
}

// What lies between two halves of a sphere is the longer the finer it is, by no more than how it zigzags.
TEST(BorderLengths, OfABallCutInTwoAreAboutItsEquator) {
  const TriMesh ball = testing::ball(4);
  const std::vector<VertexPair> edges = surfaceEdges(ball).edges;
  const std::vector<double> lengths = borderLengths(ball.positions, ball.triangles, edges);
  double border = 0;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if ((ball.positions[edges[e][0]].x() > 0.01f) != (ball.positions[edges[e][1]].x() > 0.01f)) border += lengths[e];
  }
  EXPECT_GT(border, 6.2);
  EXPECT_LT(border, 9);
}

TEST(BorderLengths, TrianglesWithoutAreaHaveNone) {
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}};
  mesh.triangles = {{0, 0, 1}};
  const std::vector<VertexPair> edges = surfaceEdges(mesh).edges;
  EXPECT_EQ(borderLengths(mesh.positions, mesh.triangles, edges).size(), edges.size());
}

}  // namespace
}  // namespace limber
