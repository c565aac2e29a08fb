#include "limber/rigging/weights/specks.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/weight_method.h"

namespace limber {
namespace {

// A closed tube along x, one long.
TriMesh body() {
  return testing::moved(testing::tube(40, 16, true), {1, 2, 2}, Vec3f::Zero());
}

// Three triangles round a vertex, 3 hundredths wide, at a position and randomly rotated.
TriMesh speck(const Vec3f& at, std::mt19937& random) {
  const Quat turn =
      Quat(Vec4(1.0 * (random() % 100) - 50, 1.0 * (random() % 100) - 50, 1.0 * (random() % 100) - 50, 7)).normalized();
  TriMesh mesh = {{{0, 0, 0.005f}, {0.02f, 0, 0}, {-0.01f, 0.015f, 0}, {-0.01f, -0.015f, 0}},
                  {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}}};
  for (Vec3f& p : mesh.positions) p = turn.cast<float>() * p + at;
  return mesh;
}

// Balls along the tube, as handles are.
std::vector<Bone> handles() {
  std::vector<Bone> bones;
  for (Index j = 0; j < 11; ++j) bones.push_back({j, {0.1 * j - 0.5, 0, 0}, {0.1 * j - 0.5, 0, 0}, 0.05});
  return bones;
}

double largestDifference(const SkinWeights& weights, Index a, Index b) {
  std::vector<double> difference(16, 0);
  for (Index k = 0; k < weights.slots; ++k) {
    difference[weights.jointsOf(a)[k]] += weights.weightsOf(a)[k];
    difference[weights.jointsOf(b)[k]] -= weights.weightsOf(b)[k];
  }
  const auto [least, most] = std::minmax_element(difference.begin(), difference.end());
  return *most - *least;
}

struct WithSpecks {
  TriMesh mesh = body();
  Index first = mesh.vertexCount();

  WithSpecks() {
    std::mt19937 random(2);
    for (int i = 0; i < 40; ++i) {
      mesh = testing::join(mesh, speck({-0.55f + 0.027f * static_cast<float>(i), 0.3f, 0.05f * (i % 5)}, random));
    }
  }
};

TEST(Specks, FollowOnePointWhateverTheMethod) {
  const WithSpecks model;
  for (const WeightMethod& method : weightMethods()) {
    Progress progress;
    const SkinWeights weights = method.compute(model.mesh, handles(), {}, progress).weights;
    for (Index v = model.first; v < weights.vertexCount(); ++v) {
      const Index speck = model.first + (v - model.first) / 4 * 4;
      ASSERT_EQ(largestDifference(weights, v, speck), 0) << method.name << ", vertex " << v;
      double sum = 0;
      for (const float weight : weights.weightsOf(v)) sum += weight;
      ASSERT_NEAR(sum, 1, 1e-6) << method.name;
    }
  }
}

TEST(Specks, AreTornWhereEachPieceMayBend) {
  const WithSpecks model;
  Progress progress;
  WeightOptions options;
  options.pieces = PieceMode::kSoft;
  const SkinWeights weights =
      findWeightMethod("nearest-bone").compute(model.mesh, handles(), options, progress).weights;
  double most = 0;
  for (Index v = model.first; v < weights.vertexCount(); ++v) {
    most = std::max(most, largestDifference(weights, v, model.first + (v - model.first) / 4 * 4));
  }
  EXPECT_GT(most, 0.1);
}

SkinWeights differentWeights(const TriMesh& mesh) {
  SkinWeights weights{1, {}, {}};
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    weights.joints.push_back(v);
    weights.weights.push_back(1);
  }
  return weights;
}

TEST(Specks, AreSmallAndOfFewTriangles) {
  const auto stays = [](const TriMesh& piece) {
    const TriMesh mesh = testing::join(body(), piece);
    SkinWeights weights = differentWeights(mesh);
    holdSpecks(mesh, weights);
    return weights.joints == differentWeights(mesh).joints;
  };
  std::mt19937 random(3);
  const TriMesh small = speck({0, 1, 0}, random);
  EXPECT_FALSE(stays(small));
  EXPECT_TRUE(stays(testing::moved(small, Vec3f::Constant(4), {0, 0, 0})));
  EXPECT_TRUE(stays(testing::moved(testing::icosphere(1), Vec3f::Constant(0.02f), {0, 1, 0})));
}

TEST(Specks, AModelThatIsMadeOfThemStaysAsItIs) {
  std::mt19937 random(4);
  TriMesh mesh;
  for (int i = 0; i < 60; ++i) mesh = testing::join(mesh, speck({0.02f * static_cast<float>(i), 0, 0}, random));
  SkinWeights weights = differentWeights(mesh);
  holdSpecks(mesh, weights);
  EXPECT_EQ(weights.joints, differentWeights(mesh).joints);
}

TEST(Specks, KeepTheStrongestOfTheirMeanWeights) {
  std::mt19937 random(5);
  const TriMesh mesh = testing::join(body(), speck({0, 1, 0}, random));
  SkinWeights weights{2, std::vector<Index>(std::size_t{2} * mesh.vertexCount(), 0),
                      std::vector<float>(std::size_t{2} * mesh.vertexCount(), 0.0f)};
  const Index first = mesh.vertexCount() - 4;
  for (Index v = first; v < mesh.vertexCount(); ++v) {
    const Index k = v - first;
    weights.joints[std::size_t{2} * v] = k < 3 ? 5u : 6u;
    weights.weights[std::size_t{2} * v] = 0.75f;
    weights.joints[std::size_t{2} * v + 1] = 1 + k;
    weights.weights[std::size_t{2} * v + 1] = 0.25f;
  }
  holdSpecks(mesh, weights);
  for (Index v = first; v < mesh.vertexCount(); ++v) {
    EXPECT_EQ(weights.jointsOf(v)[0], 5u);
    EXPECT_EQ(weights.jointsOf(v)[1], 6u);
    EXPECT_FLOAT_EQ(weights.weightsOf(v)[0], 0.75f);
    EXPECT_FLOAT_EQ(weights.weightsOf(v)[1], 0.25f);
  }
}

}  // namespace
}  // namespace limber
