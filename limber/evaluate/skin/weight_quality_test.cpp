// Weights on grids, counted by hand and by a search independent of the measure.
#include "limber/evaluate/skin/weight_quality.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

// Each vertex follows the joint that `jointAt` says by `most`, and joint 0 by the rest.
template <class JointAt>
SkinnedModel boundModel(TriMesh mesh, const JointAt& jointAt, float most = 1) {
  SkinnedModel model;
  model.mesh = std::move(mesh);
  model.weights.slots = 2;
  for (const Vec3f& p : model.mesh.positions) {
    const Index joint = jointAt(p);
    const float own = joint == 0 ? 1 : most;
    model.weights.joints.insert(model.weights.joints.end(), {joint, 0});
    model.weights.weights.insert(model.weights.weights.end(), {own, 1 - own});
  }
  return model;
}

TEST(WeightQuality, OneRegionForEachJointHasNoIslands) {
  const WeightQuality quality = measureWeights(
      boundModel(limber::testing::flatGrid(9, 9), [](const Vec3f& p) { return p.x() < 0.5f ? 1u : 2u; }));
  EXPECT_NEAR(quality.islands, 0, 1e-12);
  EXPECT_EQ(quality.influences, 1);
}

// Ten columns of vertices: 1 1 2 2 2 2 2 2 2 1: the last one is cut off from the first two. By area, columns at the
// border count half: 0.5 of 9.
TEST(WeightQuality, WhatIsCutOffIsAnIsland) {
  const SkinnedModel model = boundModel(limber::testing::flatGrid(9, 9),
                                        [](const Vec3f& p) { return p.x() < 0.15f || p.x() > 0.95f ? 1u : 2u; });
  EXPECT_NEAR(measureWeights(model).islands, 0.5 / 9, 1e-3);
}

TEST(WeightQuality, PiecesOfASurfaceAreNoIslands) {
  const TriMesh one = limber::testing::flatGrid(4, 4);
  const TriMesh two = limber::testing::join(one, limber::testing::moved(one, Vec3f::Ones(), {3, 0, 0}));
  EXPECT_NEAR(measureWeights(boundModel(two, [](const Vec3f&) { return 1u; })).islands, 0, 1e-12);
}

TEST(WeightQuality, InfluencesAreCountedAboveThe256thPart) {
  const auto second = [](const Vec3f& p) { return p.x() < 0.5f ? 0u : 1u; };
  const TriMesh grid = limber::testing::flatGrid(3, 3);  // two columns of four each
  EXPECT_NEAR(measureWeights(boundModel(grid, second, 0.75f)).influences, 1.5, 1e-12);
  EXPECT_NEAR(measureWeights(boundModel(grid, second, 0.999f)).influences, 1, 1e-12);
}

// Joints change across one of three columns of squares: 4 edges along x and 3 diagonals of 33 edges, by 2 each.
TEST(WeightQuality, RoughnessIsTheChangeAlongEdges) {
  const auto half = [](const Vec3f& p) { return p.x() < 0.5f ? 0u : 1u; };
  const SkinnedModel model = boundModel(limber::testing::flatGrid(3, 3), half);
  EXPECT_NEAR(measureWeights(model).roughness, 2 * 7 / 33.0, 1e-6);
}

TEST(WeightQuality, WithoutWeightsThereIsNothing) {
  SkinnedModel model = boundModel(limber::testing::flatGrid(3, 3), [](const Vec3f&) { return 0u; });
  std::fill(model.weights.weights.begin(), model.weights.weights.end(), 0.0f);
  const WeightQuality quality = measureWeights(model);
  EXPECT_EQ(quality.islands, 0);
  EXPECT_EQ(quality.influences, 0);
  EXPECT_EQ(quality.roughness, 0);
}

// Joint by joint, a region is walked from each of its vertices over the triangles.
double islandsByWalking(const SkinnedModel& model, Index joints) {
  const std::vector<double> areas = vertexAreas(model.mesh);
  const std::vector<Index> pieces = vertexComponents(model.mesh);
  std::vector<std::set<Index>> next(areas.size());
  for (const Triangle& t : model.mesh.triangles) {
    for (const Index a : t) next[a].insert(t.begin(), t.end());
  }
  double all = 0, most = 0;
  for (Index joint = 0; joint < joints; ++joint) {
    std::vector<double> own(areas.size(), 0);
    for (Index v = 0; v < own.size(); ++v) {
      for (Index k = 0; k < model.weights.slots; ++k) {
        const float weight = model.weights.weightsOf(v)[k];
        if (model.weights.jointsOf(v)[k] == joint && weight > 1.0f / 256) own[v] = weight;
      }
    }
    std::map<Index, double> largest;
    std::vector<bool> seen(own.size(), false);
    for (Index start = 0; start < own.size(); ++start) {
      if (seen[start] || own[start] == 0) continue;
      double fraction = 0;
      std::vector<Index> open = {start};
      seen[start] = true;
      while (!open.empty()) {
        const Index v = open.back();
        open.pop_back();
        fraction += own[v] * areas[v];
        for (const Index n : next[v]) {
          if (!seen[n] && own[n] > 0) {
            seen[n] = true;
            open.push_back(n);
          }
        }
      }
      all += fraction;
      largest[pieces[start]] = std::max(largest[pieces[start]], fraction);
    }
    for (const auto& [piece, fraction] : largest) most += fraction;
  }
  return all > 0 ? 1 - most / all : 0;
}

class WeightQualityOverTheCatalogue : public ::testing::TestWithParam<limber::testing::NamedMesh> {};

TEST_P(WeightQualityOverTheCatalogue, IslandsAreThoseOfAWalk) {
  Random random(5);
  SkinnedModel model = boundModel(
      GetParam().mesh, [&](const Vec3f&) { return static_cast<Index>(random.below(5)); }, 0.6f);
  EXPECT_NEAR(measureWeights(model).islands, islandsByWalking(model, 5), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, WeightQualityOverTheCatalogue, ::testing::ValuesIn(limber::testing::catalogue()),
                         limber::testing::MeshName());

}  // namespace
}  // namespace limber
