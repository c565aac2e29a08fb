// The cover as a closed surface of glued triangles, before and after its edges are flipped.
#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/geometry/solve/intrinsic_triangulation.h"

namespace limber {
namespace {

using testing::catalogue;
using testing::NamedMesh;

IntrinsicTriangulation coverOf(const TriMesh& mesh) {
  return tuftedCover(mesh, vertexComponents(mesh));
}

// Every side is glued to one of the same length that runs in the opposite direction.
void expectGlued(const IntrinsicTriangulation& t) {
  for (Index h = 0; h < t.sideCount(); ++h) {
    const Index twin = t.twin[h];
    ASSERT_LT(twin, t.sideCount());
    EXPECT_NE(twin, h);
    EXPECT_EQ(t.twin[twin], h);
    EXPECT_EQ(t.from[twin], t.from[nextSide(h)]);
    EXPECT_EQ(t.length[twin], t.length[h]);
  }
}

double areaOfFace(const IntrinsicTriangulation& t, Index h) {
  const long double a = t.length[h], b = t.length[h + 1], c = t.length[h + 2], s = (a + b + c) / 2;
  return static_cast<double>(std::sqrt(std::max(0.0L, s * (s - a) * (s - b) * (s - c))));
}

double totalArea(const IntrinsicTriangulation& t) {
  double sum = 0;
  for (Index h = 0; h < t.sideCount(); h += 3) sum += areaOfFace(t, h);
  return sum;
}

class TuftedCover : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(TuftedCover, IsClosedBeforeAndAfterFlips) {
  IntrinsicTriangulation t = coverOf(GetParam().mesh);
  expectGlued(t);
  const Index sides = t.sideCount();
  delaunayFlips(t);
  expectGlued(t);
  EXPECT_EQ(t.sideCount(), sides);
}

TEST_P(TuftedCover, TriangleInequalitiesHold) {
  IntrinsicTriangulation t = coverOf(GetParam().mesh);
  for (int pass = 0; pass < 2; ++pass) {
    for (Index h = 0; h < t.sideCount(); ++h) {
      const double a = t.length[h], b = t.length[nextSide(h)], c = t.length[nextSide(nextSide(h))];
      EXPECT_GT(a, 0);
      EXPECT_LT(a, b + c);
    }
    delaunayFlips(t);
  }
}

TEST_P(TuftedCover, FlipsKeepTheArea) {
  IntrinsicTriangulation t = coverOf(GetParam().mesh);
  const double before = totalArea(t);
  delaunayFlips(t);
  EXPECT_NEAR(totalArea(t), before, 1e-7 * before);
}

TEST_P(TuftedCover, EveryEdgeIsDelaunayInTheEnd) {
  IntrinsicTriangulation t = coverOf(GetParam().mesh);
  delaunayFlips(t);
  const auto angleOpposite = [&](Index h) {  // law of cosines, unlike the cotangents of the code
    const double a = t.length[h], b = t.length[nextSide(h)], c = t.length[nextSide(nextSide(h))];
    return std::acos(std::clamp((b * b + c * c - a * a) / (2 * b * c), -1.0, 1.0));
  };
  for (Index h = 0; h < t.sideCount(); ++h) {
    EXPECT_LE(angleOpposite(h) + angleOpposite(t.twin[h]), kPi + 1e-6);
    EXPECT_GE(t.cotangent[h] + t.cotangent[t.twin[h]], -1e-8);
  }
  EXPECT_EQ(delaunayFlips(t), 0u) << "a second pass finds nothing to do";
}

INSTANTIATE_TEST_SUITE_P(, TuftedCover, ::testing::ValuesIn(catalogue()), testing::MeshName());

TEST(TuftedCoverSides, ClosedOrientedPiecesAreCoveredOnce) {
  const TriMesh ball = testing::icosphere(1);
  EXPECT_EQ(coverOf(ball).sideCount(), 3 * ball.triangleCount());
  TriMesh turned = ball;
  std::swap(turned.triangles[5][0], turned.triangles[5][1]);
  EXPECT_EQ(coverOf(turned).sideCount(), 6 * ball.triangleCount());
  const TriMesh open = testing::flatGrid(3, 3);
  EXPECT_EQ(coverOf(open).sideCount(), 6 * open.triangleCount());
  const IntrinsicTriangulation both = coverOf(testing::join(ball, open));
  EXPECT_EQ(both.sideCount(), 3 * ball.triangleCount() + 6 * open.triangleCount());
  EXPECT_EQ(both.twoSided.front(), 0);
  EXPECT_EQ(both.twoSided.back(), 1);
}

TEST(TuftedCoverSides, PagesOfABookAreGluedToTheirNeighbours) {
  // Seven pages round one edge, of either winding: each side of a page must meet the facing side of the next.
  const TriMesh book = testing::pages(7);
  const IntrinsicTriangulation t = coverOf(book);
  const auto pageOf = [](Index vertex) { return (vertex - 3) / 3; };
  int seen = 0;
  for (Index h = 0; h < t.sideCount(); ++h) {
    if (t.from[h] > 2 || t.from[nextSide(h)] > 2) continue;  // not on the spine
    const Index here = pageOf(t.from[nextSide(nextSide(h))]), there = pageOf(t.from[nextSide(nextSide(t.twin[h]))]);
    const bool up = t.from[h] < t.from[nextSide(h)];
    EXPECT_EQ(there, (here + (up ? 1 : 6)) % 7);
    ++seen;
  }
  EXPECT_EQ(seen, 2 * 2 * 7);  // two edges, two sides of each page
}

TEST(TuftedCoverSides, LengthsOfGoodMeshesStayExact) {
  const TriMesh ball = testing::icosphere(2);
  const IntrinsicTriangulation t = coverOf(ball);
  for (Index h = 0; h < t.sideCount(); ++h) {
    EXPECT_EQ(t.length[h], (ball.position(std::min(t.from[h], t.from[nextSide(h)])) -
                            ball.position(std::max(t.from[h], t.from[nextSide(h)])))
                               .norm());
  }
}

TEST(TuftedCoverSides, MollifyingMovesLengthsByLittle) {
  const TriMesh grid = testing::sliveredGrid();
  const IntrinsicTriangulation t = coverOf(grid);
  double mean = 0;
  for (const double length : t.length) mean += length / t.sideCount();
  for (Index h = 0; h < t.sideCount(); ++h) {
    const double exact = (grid.position(t.from[h]) - grid.position(t.from[nextSide(h)])).norm();
    EXPECT_GT(t.length[h], exact);
    EXPECT_LT(t.length[h], exact + 2e-5 * mean);
  }
}

TEST(DelaunayFlips, TurnsTheLongDiagonalOfAKite) {
  // A kite whose stored diagonal is the long one, doubled to a closed pillow.
  TriMesh kite;
  kite.positions = {{-2, 0, 0}, {2, 0, 0}, {0, 0.5f, 0}, {0, -0.5f, 0}};
  kite.triangles = {{0, 1, 2}, {1, 0, 3}};
  IntrinsicTriangulation t = coverOf(kite);
  EXPECT_GE(delaunayFlips(t), 2u);  // on either side of the pillow
  int across = 0;
  for (Index h = 0; h < t.sideCount(); ++h) {
    if (std::minmax(t.from[h], t.from[nextSide(h)]) == std::minmax(Index{2}, Index{3})) {
      EXPECT_NEAR(t.length[h], 1, 1e-12);
      ++across;
    }
  }
  EXPECT_EQ(across, 4);  // an edge on each side of the pillow, two sides each
}

TEST(TuftedCoverSides, RepeatedVerticesAreLeftOut) {
  TriMesh mesh = testing::flatGrid(2, 2);
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_EQ(coverOf(mesh).sideCount(), 6 * 8u);
  EXPECT_EQ(coverOf(TriMesh{{{0, 0, 0}}, {}}).sideCount(), 0u);
}

TEST(TuftedCoverSides, AllCornersAtOnePlace) {
  TriMesh mesh = testing::flatGrid(2, 2);
  for (Vec3f& p : mesh.positions) p.setZero();
  IntrinsicTriangulation t = coverOf(mesh);
  delaunayFlips(t);
  for (const double length : t.length) EXPECT_GT(length, 0);
}

}  // namespace
}  // namespace limber
