#include "limber/actions/parts/shape_parts.h"

#include <algorithm>
#include <array>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/parts/testing/part_meshes_made.h"
#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

class ShapePartsOf : public ::testing::TestWithParam<testing::NamedMesh> {};
INSTANTIATE_TEST_SUITE_P(Catalogue, ShapePartsOf, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST_P(ShapePartsOf, AreAPartitionWhateverTheNumberOfThreads) {
  const TriMesh mesh = prepareMesh(GetParam().mesh.positions, GetParam().mesh.triangles).mesh;
  Progress progress;
  for (const std::optional<Index> count : {std::optional<Index>(), std::optional<Index>(1), std::optional<Index>(4)}) {
    setThreadCount(1);
    const SurfaceParts one = partsByShape(mesh, {count}, progress);
    setThreadCount(4);
    const SurfaceParts four = partsByShape(mesh, {count}, progress);
    setThreadCount(0);
    EXPECT_EQ(one.partOf, four.partOf);
    ASSERT_EQ(one.partOf.size(), mesh.triangles.size());
    const std::set<Index> used(one.partOf.begin(), one.partOf.end());
    EXPECT_EQ(used.size(), one.names.size());
    EXPECT_EQ(*used.rbegin() + 1, one.names.size());
    if (count) {
      EXPECT_LE(one.names.size(), *count);
    }
  }
}

TEST(ShapeParts, TwoBallsAreCutAtTheNeckBetweenThem) {
  const TriMesh mesh = testing::dumbbell();
  Progress progress;
  const SurfaceParts parts = partsByShape(mesh, {2}, progress);
  ASSERT_THAT(parts.names, ::testing::ElementsAre("part_01", "part_02"));
  const Index left = parts.partOf[0];
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const double x = testing::middleX(mesh, t);
    if (x > 0.3 && x < 1.95) {
      EXPECT_EQ(parts.partOf[t], left) << x;
    }
    if (x > 2.25 && x < 3.9) {
      EXPECT_EQ(parts.partOf[t], 1 - left) << x;
    }
  }
}

TEST(ShapeParts, APersonOfBlocksFallsIntoTrunkLimbsAndHead) {
  const testing::BlockPerson person = testing::blockPerson();
  const FaceGraph graph = faceGraph(person.mesh);
  Progress progress;
  const SurfaceParts parts = partsByShape(graph, {}, progress);
  ASSERT_EQ(parts.names.size(), 6u);
  std::array<std::array<double, 6>, 6> shared = {};
  std::array<double, 6> areas = {};
  for (Index t = 0; t < graph.faceCount(); ++t) {
    shared[person.partOf[t]][parts.partOf[t]] += graph.areas[t];
    areas[person.partOf[t]] += graph.areas[t];
  }
  std::set<std::ptrdiff_t> own;
  for (std::size_t limb = 0; limb < 6; ++limb) {
    const auto best = std::max_element(shared[limb].begin(), shared[limb].end());
    EXPECT_GT(*best, (limb == 0 ? 0.8 : 0.9) * areas[limb]) << limb;
    own.insert(best - shared[limb].begin());
  }
  EXPECT_EQ(own.size(), 6u);
}

TEST(ShapeParts, FuzzyProbabilitiesAreThePapers) {
  // p1 = d2 / (d1 + d2) for the nearest, p2 = 1 - p1.
  const std::vector<std::vector<double>> distances = {{0, 1, 4, 3}, {2, 3, 4, 1}, {5, 9, 9, 2}};
  const FuzzyParts fuzzy = fuzzyByDistance(distances);
  EXPECT_THAT(fuzzy.first, ::testing::ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(fuzzy.second, ::testing::ElementsAre(1, 1, 1, 2));
  for (std::size_t f = 0; f < 4; ++f) {
    const double d1 = distances[fuzzy.first[f]][f], d2 = distances[fuzzy.second[f]][f];
    EXPECT_NEAR(static_cast<double>(fuzzy.lead[f]), d2 / (d1 + d2) - d1 / (d1 + d2), 1e-6);
  }
  const FuzzyParts alone = fuzzyByDistance(std::vector<std::vector<double>>{{0, 3}});
  EXPECT_THAT(alone.lead, ::testing::Each(1.0f));
}

TEST(ShapeParts, PatchesHoldWhatIsNearestToTheirSeeds) {
  const FaceGraph graph = faceGraph(testing::icosphere(2));
  Progress progress;
  const FacePatches patches = growPatches(graph, 17, progress);
  ASSERT_EQ(patches.seeds.size(), 17u);
  std::vector<std::vector<double>> distances;
  for (const Index seed : patches.seeds) distances.push_back(distancesFrom(graph, seed));
  for (Index t = 0; t < graph.faceCount(); ++t) {
    double least = 1e300;
    for (const std::vector<double>& from : distances) least = std::min(least, from[t]);
    EXPECT_EQ(patches.seedDistance[t], least);
    EXPECT_EQ(distances[patches.patchOf[t]][t], least);
  }
}

TEST(ShapeParts, GrowingStopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(growPatches(faceGraph(testing::icosphere(2)), 17, progress), Error);
}

TEST(ShapeParts, AreTheSameForAnyNumberOfThreads) {
  const TriMesh mesh = testing::dumbbell(61, 30);  // 3600 triangles: more than patches
  const auto partsWith = [&](int threads) {
    setThreadCount(threads);
    Progress progress;
    const std::vector<Index> partOf = partsByShape(mesh, {5}, progress).partOf;
    setThreadCount(0);
    return partOf;
  };
  const std::vector<Index> alone = partsWith(1);
  EXPECT_GT(*std::max_element(alone.begin(), alone.end()), 1u);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(partsWith(threads), alone) << threads;
}

TEST(ShapeParts, MoreTrianglesThanPatchesGiveTheSameParts) {
  const TriMesh mesh = testing::dumbbell(121, 60);  // 14,000 triangles
  Progress progress;
  const SurfaceParts parts = partsByShape(mesh, {2}, progress);
  ASSERT_EQ(parts.names.size(), 2u);
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const double x = testing::middleX(mesh, t);
    if (x > 0.3 && x < 1.95) {
      EXPECT_EQ(parts.partOf[t], parts.partOf[0]) << x;
    }
    if (x > 2.25 && x < 3.9) {
      EXPECT_NE(parts.partOf[t], parts.partOf[0]) << x;
    }
  }
}

TEST(ShapeParts, NothingHasNoParts) {
  Progress progress;
  EXPECT_EQ(partsByShape(TriMesh{}, {}, progress).partCount(), 0u);
}

TEST(ShapeParts, RefusesCountsThatItCannotTellApart) {
  Progress progress;
  for (const Index count : {Index{0}, kMaxShapeParts + 1}) {
    EXPECT_THROW(partsByShape(testing::icosphere(1), {count}, progress), Error);
  }
}

}  // namespace
}  // namespace limber
