// The measures on models small enough to know the answer by hand.
#include "limber/evaluate/skin/weight_metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/evaluate/pairing.h"
#include "limber/evaluate/skin/random_pose.h"
#include "limber/evaluate/skin/weight_report.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Four vertices along x, two joints at its ends.
SkinnedModel strip(std::vector<std::vector<std::pair<Index, float>>> influences) {
  SkinnedModel model;
  model.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  model.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  model.skeleton.joints = {{"root", std::nullopt, {}, 0},
                           {"tip", 0, {Vec3(1, 0, 0), Quat::Identity(), Vec3::Ones()}, 0}};
  model.weights.slots = 4;
  for (const auto& vertex : influences) {
    for (Index slot = 0; slot < 4; ++slot) {
      model.weights.joints.push_back(slot < vertex.size() ? vertex[slot].first : 0);
      model.weights.weights.push_back(slot < vertex.size() ? vertex[slot].second : 0);
    }
  }
  return model;
}

SkinnedModel truthStrip() {
  return strip({{{0, 1.0f}}, {{1, 0.75f}, {0, 0.25f}}, {{1, 1.0f}}, {{0, 1.0f}}});
}

TEST(CompareWeights, TheSameIsPerfect) {
  const WeightComparison c = compareWeights(truthStrip(), truthStrip());
  EXPECT_EQ(c.vertices, 4u);
  EXPECT_TRUE(c.orderKept);
  EXPECT_EQ(c.l1, 0);
  EXPECT_EQ(c.precision, 1);
  EXPECT_EQ(c.recall, 1);
  EXPECT_EQ(c.deformMean, 0);
  EXPECT_EQ(c.deformP95, 0);
  EXPECT_EQ(c.unweighted, 0u);
  EXPECT_EQ(c.usedJoints, 2u);
}

TEST(CompareWeights, InfluencesAreCountedByHand) {
  // Vertex 1: |0.25 - 0.75| + |0.75 - 0.25| = 1; vertex 2 on the other joint: 2; vertex 3 without weights: 1.
  const SkinnedModel result = strip({{{0, 1.0f}}, {{0, 0.75f}, {1, 0.25f}}, {{0, 1.0f}}, {}});
  const WeightComparison c = compareWeights(result, truthStrip());
  EXPECT_NEAR(c.l1, (0 + 1 + 2 + 1) / 4.0, 1e-6);
  EXPECT_NEAR(c.precision, 3.0 / 4, 1e-9);
  EXPECT_NEAR(c.recall, 3.0 / 5, 1e-9);
  EXPECT_EQ(c.unweighted, 1u);
  EXPECT_EQ(c.truthUnweighted, 0u);
}

TEST(CompareWeights, InfluencesBelowOne256thDoNotCount) {
  const SkinnedModel result = strip({{{0, 0.997f}, {1, 0.003f}}, {{1, 0.75f}, {0, 0.25f}}, {{1, 1.0f}}, {{0, 1.0f}}});
  const WeightComparison c = compareWeights(result, truthStrip());
  EXPECT_EQ(c.precision, 1);
  EXPECT_NEAR(c.l1, 0.006 / 4, 1e-6);
}

TEST(CompareWeights, SmoothnessIsTheMeanOverEdges) {
  // Edges 01: 1.5, 12: 0.5, 02: 2, 23: 2, 03: 0.
  const WeightComparison c = compareWeights(truthStrip(), truthStrip());
  EXPECT_NEAR(c.truthSmoothness, 6.0 / 5, 1e-6);
  EXPECT_NEAR(c.smoothness, 6.0 / 5, 1e-6);
}

// Two squares, each bound to a joint; the grid of the second one has moved it off the first.
TEST(CompareWeights, SmoothnessGoesAcrossSeamsOfGrids) {
  const std::vector<std::pair<Index, float>> left = {{0, 1.0f}}, right = {{1, 1.0f}};
  SkinnedModel model = strip({left, left, left, left, right, right, right, right});
  for (Index v = 0; v < 4; ++v) model.mesh.positions.push_back(model.mesh.positions[v] + Vec3f(1.01f, 0, 0));
  model.mesh.triangles.insert(model.mesh.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  EXPECT_EQ(compareWeights(model, model).truthSmoothness, 0);
  model.stored = {{0, 4, Vec3::Zero(), 0.02}, {4, 4, Vec3::Zero(), 0.02}};
  EXPECT_NEAR(compareWeights(model, model).truthSmoothness, 3 * 2.0 / 9, 1e-6);
}

TEST(CompareWeights, DeformationIsTheDistanceInEachPose) {
  const SkinnedModel result = strip({{{0, 1.0f}}, {{1, 1.0f}}, {{1, 1.0f}}, {{1, 1.0f}}});
  const WeightComparison c = compareWeights(result, truthStrip());

  SplitMix random(1);
  double mean = 0;
  std::vector<double> p95;
  for (int pose = 0; pose < 20; ++pose) {
    const std::vector<Affine> skin =
        skinTransforms(truthStrip().skeleton, randomPose(truthStrip().skeleton, kPi / 6, random));
    const double first = 0.25 * (skin[0] * Vec3(1, 0, 0) - skin[1] * Vec3(1, 0, 0)).norm();
    const double second = (skin[0] * Vec3(0, 1, 0) - skin[1] * Vec3(0, 1, 0)).norm();
    std::vector<double> sorted = {0, 0, first, second};
    std::sort(sorted.begin(), sorted.end());
    mean += (first + second) / 4 / 20;
    p95.push_back(sorted[2] + 0.85 * (sorted[3] - sorted[2]));
  }
  EXPECT_NEAR(c.deformMean, 100 * mean / std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(c.deformP95, 100 * std::accumulate(p95.begin(), p95.end(), 0.0) / 20 / std::sqrt(2.0), 1e-4);
}

TEST(CompareWeights, VerticesInAnotherOrderAndSplitAreFoundAgain) {
  SkinnedModel result = truthStrip();
  std::reverse(result.mesh.positions.begin(), result.mesh.positions.end());
  for (Triangle& t : result.mesh.triangles) {
    for (Index& v : t) v = 3 - v;
  }
  result.mesh.positions.push_back(result.mesh.positions.front());
  SkinWeights reversed;
  reversed.slots = 4;
  for (const Index v : {3u, 2u, 1u, 0u, 3u}) {
    const auto joints = result.weights.jointsOf(v);
    const auto weights = result.weights.weightsOf(v);
    reversed.joints.insert(reversed.joints.end(), joints.begin(), joints.end());
    reversed.weights.insert(reversed.weights.end(), weights.begin(), weights.end());
  }
  result.weights = reversed;
  const WeightComparison c = compareWeights(result, truthStrip());
  EXPECT_FALSE(c.orderKept);
  EXPECT_EQ(c.vertices, 4u);
  EXPECT_EQ(c.l1, 0);
}

TEST(CompareWeights, JointsAreFoundByNameAndStrangersCountAsWrong) {
  SkinnedModel result = truthStrip();
  result.skeleton.joints = {{"extra", std::nullopt, {}, 0}, {"root", 0, {}, 0}, {"stranger", 1, {}, 0}};
  for (Index& joint : result.weights.joints) joint += 1;
  const WeightComparison c = compareWeights(result, truthStrip());
  EXPECT_EQ(c.unpairedJoints, 1u);
  EXPECT_NEAR(c.l1, (0 + 1.5 + 2 + 0) / 4, 1e-6);
}

TEST(CompareWeights, OtherModelIsRefused) {
  SkinnedModel other = truthStrip();
  for (Vec3f& p : other.mesh.positions) p += Vec3f(10, 0, 0);
  EXPECT_THROW(compareWeights(other, truthStrip()), Error);
}

TEST(StrongestFour, KeepsFourToASumOfOne) {
  SkinWeights six;
  six.slots = 6;
  six.joints = {0, 1, 2, 3, 4, 5};
  six.weights = {0.1f, 0.3f, 0.05f, 0.2f, 0.15f, 0.2f};
  const SkinWeights four = strongestFour(six);
  EXPECT_THAT(std::vector<Index>(four.jointsOf(0).begin(), four.jointsOf(0).end()), ElementsAre(1, 3, 5, 4));
  EXPECT_NEAR(four.weightsOf(0)[0], 0.3 / 0.85, 1e-6);
  EXPECT_NEAR(four.weightsOf(0)[3], 0.15 / 0.85, 1e-6);
}

TEST(StrongestFour, WhatIsNotANumberIsNoWeight) {
  SkinWeights broken;
  broken.slots = 2;
  broken.joints = {0, 1};
  broken.weights = {std::nanf(""), 0.5f};
  EXPECT_EQ(strongestFour(broken).weightsOf(0)[0], 1.0f);
  EXPECT_EQ(strongestFour(broken).jointsOf(0)[0], 1u);
}

TEST(PairVertices, NormalTellsVerticesAtOnePlaceApart) {
  // Two sheets back to back, in the other order in the second mesh.
  TriMesh from, to;
  from.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}};
  from.triangles = {{0, 1, 2}, {3, 4, 5}};
  to.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  to.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_THAT(pairVertices(from, to).partner, ElementsAre(3, 4, 5, 0, 1, 2));
}

TEST(PairJoints, ByIndexOnlyWhereNoNameIsShared) {
  Skeleton a, b;
  a.joints = {{"one", std::nullopt, {}, 0}, {"two", 0, {}, 0}};
  b.joints = {{"x", std::nullopt, {}, 0}, {"y", 0, {}, 0}};
  EXPECT_THAT(pairJoints(a, b), ElementsAre(0, 1));
  b.joints[0].name = "two";
  EXPECT_THAT(pairJoints(a, b), ElementsAre(kNoIndex, 0));
}

TEST(SplitMix, IsThePublishedSequence) {
  SplitMix random(0);
  EXPECT_EQ(random.next(), 0xE220A8397B1DCDAFu);
  EXPECT_EQ(random.next(), 0x6E789E6AA1B965F4u);
  EXPECT_EQ(random.next(), 0x06C45D188009454Fu);
}

TEST(RandomPose, TurnsEachJointByUpToTheAngleAndMovesNone) {
  SplitMix random(5);
  const Skeleton skeleton = truthStrip().skeleton;
  double most = 0;
  for (int i = 0; i < 300; ++i) {
    const Pose pose = randomPose(skeleton, 0.5, random);
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      most = std::max(most, pose.locals[j].rotation.angularDistance(skeleton.joints[j].rest.rotation));
      EXPECT_EQ(pose.locals[j].translation, skeleton.joints[j].rest.translation);
    }
  }
  EXPECT_LE(most, 0.5 + 1e-9);
  EXPECT_GT(most, 0.48);
}

TEST(WeightReport, NamesEveryFigure) {
  const WeightComparison c = compareWeights(strip({{{0, 1.0f}}, {{1, 1.0f}}, {{1, 1.0f}}, {}}), truthStrip());
  const Json json = toJson(c);
  EXPECT_EQ(json["unweighted"], 1);
  EXPECT_EQ(json["l1"], c.l1);
  EXPECT_EQ(json["deform_mean"], c.deformMean);
  EXPECT_THAT(toText(c), HasSubstr("left out      1 vertex (truth 0)"));
}

}  // namespace
}  // namespace limber
