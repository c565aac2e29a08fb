#include "limber/actions/parts/fuzzy_cut.h"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/random.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

double cutOf(const FaceGraph& graph, const std::vector<Index>& partOf) {
  double cut = 0;
  for (const FaceArc& arc : graph.arcs) {
    if (partOf[arc.a] != partOf[arc.b]) cut += arc.capacity;
  }
  return cut;
}

// Which of the open triangles lie in a patch of such, over shared edges, that touches triangles of both parts.
std::vector<Index> between(const FaceGraph& graph, const FuzzyParts& fuzzy, const std::vector<Index>& open) {
  const auto isOpen = [&](Index t) { return std::find(open.begin(), open.end(), t) != open.end(); };
  std::vector<Index> found;
  for (const Index start : open) {
    std::vector<Index> patch = {start};
    std::array<bool, 2> touches = {false, false};
    for (std::size_t i = 0; i < patch.size(); ++i) {
      for (const Index a : graph.arcsAt.of(patch[i])) {
        const Index other = graph.across(a, patch[i]);
        if (!isOpen(other)) touches[fuzzy.first[other]] = true;
        const bool isNew = std::find(patch.begin(), patch.end(), other) == patch.end();
        if (isOpen(other) && isNew) patch.push_back(other);
      }
    }
    if (touches[0] && touches[1]) found.push_back(start);
  }
  return found;
}

TEST(FuzzyCut, IsTheSmallestOfAllWaysToGiveTheFuzzyTriangles) {
  const TriMesh mesh = testing::flatGrid(4, 4, 0.4f);
  const FaceGraph graph = faceGraph(mesh);
  Random random(3);
  int shorter = 0;
  for (int trial = 0; trial < 40; ++trial) {
    FuzzyParts fuzzy{std::vector<Index>(32), std::vector<Index>(32), std::vector<float>(32, 1)};
    std::vector<Index> open;
    for (Index t = 0; t < 32; ++t) {
      fuzzy.first[t] = t % 8 < 4 ? 0 : 1;
      const bool middle = t % 8 >= 1 && t % 8 < 7;
      const bool isOpen = middle && open.size() < 12 && random.below(2) > 0;
      if (isOpen) open.push_back(t);
      if (isOpen && trial % 2 == 1) fuzzy.first[t] = static_cast<Index>(random.below(2));
      if (isOpen) fuzzy.lead[t] = 0.1f;
      fuzzy.second[t] = 1 - fuzzy.first[t];
    }
    Progress progress;
    const std::vector<Index> cut = cutFuzzyParts(graph, fuzzy, 0.5, progress);
    const std::vector<Index> free = between(graph, fuzzy, open);
    double least = 1e300;
    for (unsigned choice = 0; choice < (1u << free.size()); ++choice) {
      std::vector<Index> partOf = fuzzy.first;
      for (std::size_t i = 0; i < free.size(); ++i) partOf[free[i]] = choice >> i & 1;
      least = std::min(least, cutOf(graph, partOf));
    }
    EXPECT_NEAR(cutOf(graph, cut), least, 1e-9) << trial;
    shorter += least < cutOf(graph, fuzzy.first) - 1e-9;
    for (Index t = 0; t < 32; ++t) {
      ASSERT_LT(cut[t], 2u);
      if (std::find(free.begin(), free.end(), t) == free.end()) {
        EXPECT_EQ(cut[t], fuzzy.first[t]);
      }
    }
  }
  EXPECT_GT(shorter, 10);
}

TEST(FuzzyCut, FuzzyTrianglesWithoutBothPartsBesideThemStay) {
  const TriMesh mesh = testing::flatGrid(4, 1);
  const FaceGraph graph = faceGraph(mesh);
  const FuzzyParts fuzzy{{0, 0, 0, 0, 1, 1, 1, 1}, {1, 1, 0, 0, 1, 1, 0, 0}, {0.1f, 0.1f, 1, 1, 1, 1, 0.1f, 0.1f}};
  Progress progress;
  EXPECT_EQ(cutFuzzyParts(graph, fuzzy, 0.5, progress), fuzzy.first);
  progress.cancel();
  const FuzzyParts open{{0, 0, 0, 0, 1, 1, 1, 1}, {1, 1, 1, 1, 0, 0, 0, 0}, {1, 1, 0.1f, 0.1f, 0.1f, 0.1f, 1, 1}};
  EXPECT_THROW(cutFuzzyParts(graph, open, 0.5, progress), Error);
}

TEST(MergeIslands, ScatteredTrianglesJoinWhatTheyLieIn) {
  const TriMesh mesh = testing::flatGrid(10, 10);
  const FaceGraph graph = faceGraph(mesh);
  std::vector<Index> wanted(200), partOf;
  for (Index t = 0; t < 200; ++t) wanted[t] = t % 20 < 10 ? 0 : 1;
  partOf = wanted;
  partOf[44] = partOf[45] = 1;
  partOf[133] = 0;
  Progress progress;
  mergeIslands(graph, partOf, progress);
  EXPECT_EQ(partOf, wanted);
}

TEST(MergeIslands, PiecesOfTheModelStayWhole) {
  const TriMesh ball = testing::icosphere(1);
  const TriMesh mesh = testing::join(ball, testing::moved(ball, Vec3f::Constant(0.05f), {1.1f, 0, 0}));
  const FaceGraph graph = faceGraph(mesh);
  // The small ball is all of part 1 that does not lie in the large one, and less than a tenth of it.
  std::vector<Index> partOf(160, 0);
  for (Index t = 0; t < 40; ++t) partOf[t] = 1;
  for (Index t = 80; t < 160; ++t) partOf[t] = 1;
  Progress progress;
  std::vector<Index> merged = partOf;
  mergeIslands(graph, merged, progress);
  for (Index t = 81; t < 160; ++t) EXPECT_EQ(merged[t], merged[80]) << t;
  // Of the large ball only what is scattered moves: its two parts stay, as large as before within a tenth.
  std::array<double, 2> before{}, after{};
  for (Index t = 0; t < 80; ++t) {
    ASSERT_LT(merged[t], 2u);
    before[partOf[t]] += graph.areas[t];
    after[merged[t]] += graph.areas[t];
  }
  for (const Index part : {0u, 1u}) EXPECT_NEAR(after[part], before[part], 0.1 * before[part]);
  progress.cancel();
  EXPECT_THROW(mergeIslands(graph, merged, progress), Error);
}

}  // namespace
}  // namespace limber
