#include "limber/parts/fuzzy_cut.h"

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/mesh/testing/shapes.h"

namespace limber {
namespace {

double cutOf(const FaceGraph& graph, const std::vector<Index>& partOf) {
  double cut = 0;
  for (const FaceArc& arc : graph.arcs) {
    if (partOf[arc.a] != partOf[arc.b]) cut += arc.capacity;
  }
  return cut;
}

TEST(FuzzyCut, IsTheSmallestOfAllWaysToGiveTheFuzzyTriangles) {
  const TriMesh mesh = testing::flatGrid(4, 4, 0.4f);
  const FaceGraph graph = faceGraph(mesh);
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    FuzzyParts fuzzy{std::vector<Index>(32), std::vector<Index>(32), std::vector<float>(32, 1)};
    std::vector<Index> open;
    for (Index t = 0; t < 32; ++t) {
      const bool left = t % 8 < 4;
      fuzzy.first[t] = left ? 0 : 1;
      fuzzy.second[t] = 1 - fuzzy.first[t];
      const bool middle = t % 8 >= 2 && t % 8 < 6;
      if (middle && open.size() < 12 && random.below(4) > 0) {
        fuzzy.lead[t] = 0.1f;
        open.push_back(t);
      }
    }
    const std::vector<Index> cut = cutFuzzyParts(graph, fuzzy, 0.5);
    double least = 1e300;
    for (unsigned choice = 0; choice < (1u << open.size()); ++choice) {
      std::vector<Index> partOf = fuzzy.first;
      for (std::size_t i = 0; i < open.size(); ++i) partOf[open[i]] = choice >> i & 1;
      least = std::min(least, cutOf(graph, partOf));
    }
    // Fuzzy triangles that touch no sure ones of both parts stay, which can only be dearer.
    bool apart = false;
    for (Index t = 0; t < 32; ++t) {
      if (fuzzy.lead[t] == 1) {
        EXPECT_EQ(cut[t], fuzzy.first[t]);
      }
      apart = apart || cut[t] > 1;
    }
    EXPECT_FALSE(apart);
    EXPECT_LE(cutOf(graph, cut), cutOf(graph, fuzzy.first) + 1e-12);
    EXPECT_GE(cutOf(graph, cut), least - 1e-12);
    if (open.size() == 12) {
      EXPECT_NEAR(cutOf(graph, cut), least, 1e-12) << trial;
    }
  }
}

TEST(FuzzyCut, FuzzyTrianglesWithoutBothPartsBesideThemStay) {
  const TriMesh mesh = testing::flatGrid(4, 1);
  const FaceGraph graph = faceGraph(mesh);
  const FuzzyParts fuzzy{{0, 0, 0, 0, 1, 1, 1, 1}, {1, 1, 0, 0, 1, 1, 0, 0}, {0.1f, 0.1f, 1, 1, 1, 1, 0.1f, 0.1f}};
  EXPECT_EQ(cutFuzzyParts(graph, fuzzy, 0.5), fuzzy.first);
}

TEST(MergeIslands, ScatteredTrianglesJoinWhatTheyLieIn) {
  const TriMesh mesh = testing::flatGrid(10, 10);
  const FaceGraph graph = faceGraph(mesh);
  std::vector<Index> wanted(200), partOf;
  for (Index t = 0; t < 200; ++t) wanted[t] = t % 20 < 10 ? 0 : 1;
  partOf = wanted;
  partOf[44] = partOf[45] = 1;
  partOf[133] = 0;
  mergeIslands(graph, partOf);
  EXPECT_EQ(partOf, wanted);
}

TEST(MergeIslands, PiecesOfTheModelStayWhole) {
  const TriMesh ball = testing::icosphere(1);
  const TriMesh mesh = testing::join(ball, testing::moved(ball, Vec3f::Constant(0.05f), {1.1f, 0, 0}));
  const FaceGraph graph = faceGraph(mesh);
  std::vector<Index> partOf(160, 0);
  for (Index t = 0; t < 40; ++t) partOf[t] = 1;
  for (Index t = 80; t < 160; ++t) partOf[t] = 1;
  const std::vector<Index> before = partOf;
  mergeIslands(graph, partOf);
  EXPECT_TRUE(std::equal(before.begin() + 80, before.end(), partOf.begin() + 80));
}

}  // namespace
}  // namespace limber
