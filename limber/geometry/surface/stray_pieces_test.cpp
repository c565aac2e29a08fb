#include "limber/geometry/surface/stray_pieces.h"

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/surface/piece_links.h"

namespace limber {
namespace {

// Pairs of points along x as pieces; each piece's area is shared by its two points.
struct Line {
  std::vector<Vec3f> points;
  std::vector<double> areas;
  std::vector<VertexPair> edges;

  void addPiece(float from, float to, double area) {
    const Index first = static_cast<Index>(points.size());
    points.push_back({from, 0, 0});
    points.push_back({to, 0, 0});
    areas.insert(areas.end(), 2, 0.5 * area);
    edges.push_back({first, first + 1});
  }
  std::vector<double> fractions() const { return strayFractions(points, areas, edges, pieceLinks(points, edges)); }
};

TEST(StrayPieces, ATinyPieceFarAwayCountsLittle) {
  Line line;
  line.addPiece(0, 1, 1);
  line.addPiece(1.5f, 1.6f, 0.01);
  const std::vector<double> fractions = line.fractions();
  EXPECT_EQ(fractions[0], 1);
  EXPECT_EQ(fractions[1], 1);
  EXPECT_NEAR(fractions[2], 0.0016, 1e-9);
  EXPECT_NEAR(fractions[3], 0.0016, 1e-9);
}

TEST(StrayPieces, NearAndLargePiecesCountFully) {
  Line line;
  line.addPiece(0, 1, 1);
  line.addPiece(1.05f, 1.15f, 0.01);  // nearer than it is large
  line.addPiece(-9, -8, 0.1);         // a tenth of all: a part, however far
  EXPECT_EQ(line.fractions(), std::vector<double>(6, 1));
}

TEST(StrayPieces, ManySpecksTogetherAreStrayStill) {
  Line line;
  line.addPiece(0, 1, 1);
  for (int i = 0; i < 8; ++i) line.addPiece(2 + 0.1f * i, 2.01f + 0.1f * i, 1e-4);
  const std::vector<double> fractions = line.fractions();
  EXPECT_EQ(fractions[0], 1);
  for (std::size_t v = 2; v < fractions.size(); ++v) EXPECT_NEAR(fractions[v], 6.4e-7, 1e-12);  // 1 from what is large
}

TEST(StrayPieces, AmongEqualPiecesNoneIsStray) {
  Line line;
  for (int i = 0; i < 200; ++i) line.addPiece(static_cast<float>(i), i + 0.1f, 1e-3);
  EXPECT_EQ(line.fractions(), std::vector<double>(400, 1));
}

TEST(StrayPieces, WhatFloatsAboutIsLeftOut) {
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0, 0}, {0, 1, 0}, 0.2);
  EXPECT_FALSE(withoutStrays(mesh)) << "one piece";
  testing::addCapsule(mesh, {0, 1.23, 0}, {0, 1.25, 0}, 0.02);
  const Index button = mesh.triangleCount();
  EXPECT_FALSE(withoutStrays(mesh)) << "a small piece that all but touches";
  testing::addCapsule(mesh, {2, -3, 0}, {2, -2.99, 0}, 0.02);
  const std::optional<TriMesh> cleared = withoutStrays(mesh);
  ASSERT_TRUE(cleared);
  EXPECT_EQ(cleared->positions, mesh.positions);
  EXPECT_EQ(cleared->triangleCount(), button);
}

}  // namespace
}  // namespace limber
