// What must hold of the weights of every method, on every kind of mesh.
#include <algorithm>

#include <gtest/gtest.h>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/lattice/bounded_biharmonic.h"
#include "limber/rigging/weights/lattice/geodesic_voxel.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/rigging/weights/weight_steps.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::countOf;
using testing::NamedMesh;

// Bones here and there, not all inside; one is a ball, one a point.
std::vector<Bone> bonesHereAndThere() {
  return {{0, {-0.4, 0, 0}, {-0.1, 0.02, 0}, 0},
          {1, {-0.1, 0.02, 0}, {0.2, 0, 0.03}, 0},
          {3, {0.2, 0, 0.03}, {0.45, 0.1, 0}, 0},
          {4, {0.1, 0.3, 0.05}, {0.1, 0.3, 0.05}, 0.08},
          {2, {-0.2, -0.25, 0}, {-0.2, -0.25, 0}, 0}};
}

WeightResult madeBy(const WeightMethod& method, const TriMesh& mesh, Index influences = 4) {
  Progress progress;
  WeightOptions options;
  options.maxInfluences = influences;
  return method.compute(mesh, bonesHereAndThere(), options, progress);
}

// Every method, those on lattices with fewer cells.
std::vector<WeightMethod> quickMethods() {
  std::vector<WeightMethod> methods(weightMethods().begin(), weightMethods().end());
  for (WeightMethod& method : methods) {
    if (method.name == "geodesic-voxel") {
      method.compute = [](const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                          Progress& progress) {
        GeodesicVoxelOptions voxels;
        voxels.nodes = 20'000;
        voxels.maxCells = 40;
        return geodesicVoxelWeightsWith(voxels, mesh, bones, options, progress);
      };
    }
    if (method.name == "bounded-biharmonic") {
      method.compute = [](const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options,
                          Progress& progress) {
        BoundedBiharmonicOptions biharmonic;
        biharmonic.cells = 1'000;
        return boundedBiharmonicWeightsWith(biharmonic, mesh, bones, options, progress);
      };
    }
  }
  return methods;
}

class EveryWeightMethod : public ::testing::TestWithParam<NamedMesh> {};

void expectWhole(const WeightMethod& method, const TriMesh& mesh, Index influences) {
  SCOPED_TRACE(std::string(method.name));
  const SkinWeights weights = madeBy(method, mesh, influences).weights;
  ASSERT_EQ(weights.slots, influences);
  ASSERT_EQ(weights.vertexCount(), mesh.vertexCount());
  for (Index v = 0; v < weights.vertexCount(); ++v) {
    float sum = 0, last = 2;
    for (Index k = 0; k < influences; ++k) {
      const float weight = weights.weightsOf(v)[k];
      ASSERT_GE(weight, 0);
      ASSERT_LE(weight, last);
      ASSERT_LE(weights.jointsOf(v)[k], 4u);
      last = weight;
      sum += weight;
    }
    ASSERT_NEAR(sum, 1, 1e-5);
  }
}

TEST_P(EveryWeightMethod, LeavesNoVertexOut) {
  for (const WeightMethod& method : quickMethods()) expectWhole(method, GetParam().mesh, 4);
}

INSTANTIATE_TEST_SUITE_P(, EveryWeightMethod, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST(WeightMethods, KeepAsManyInfluencesAsAreAsked) {
  const TriMesh ball = testing::moved(testing::icosphere(2), {0.5f, 0.3f, 0.2f}, Vec3f::Zero());
  for (const WeightMethod& method : quickMethods()) {
    expectWhole(method, ball, 1);
    expectWhole(method, ball, 8);
  }
}

TEST(WeightMethods, OfTheTableLeaveNoVertexOut) {
  const TriMesh bar = testing::moved(testing::icosphere(2), {0.5f, 0.1f, 0.1f}, Vec3f::Zero());
  for (const WeightMethod& method : weightMethods()) expectWhole(method, bar, 4);
}

// A floor that was taken out of the model leaves its vertices: they are no pieces of the body.
TEST(WeightMethods, LooseVerticesChangeNothing) {
  const TriMesh bar = testing::moved(testing::icosphere(2), {0.5f, 0.1f, 0.1f}, Vec3f::Zero());
  TriMesh mesh = bar;
  for (int i = 0; i < 500; ++i) mesh.positions.push_back({0.002f * float(i) - 0.5f, -0.2f, 0});
  for (const WeightMethod& method : weightMethods()) {
    const WeightResult alone = madeBy(method, bar, 4), beside = madeBy(method, mesh, 4);
    const std::size_t count = alone.weights.joints.size();
    EXPECT_TRUE(std::equal(alone.weights.joints.begin(), alone.weights.joints.end(), beside.weights.joints.begin()));
    EXPECT_TRUE(std::equal(alone.weights.weights.begin(), alone.weights.weights.end(), beside.weights.weights.begin()));
    EXPECT_EQ(beside.weights.joints.size(), count + 4 * 500);
    EXPECT_EQ(alone.warnings.items().size(), beside.warnings.items().size()) << method.name;
    expectWhole(method, mesh, 4);
  }
}

TEST(WeightMethods, GiveTheSameBitsForAnyNumberOfThreads) {
  const TriMesh ball = testing::moved(testing::icosphere(3), {0.5f, 0.3f, 0.2f}, Vec3f::Zero());
  for (const WeightMethod& method : quickMethods()) {
    setThreadCount(1);
    const SkinWeights one = madeBy(method, ball).weights;
    setThreadCount(3);
    const SkinWeights three = madeBy(method, ball).weights;
    setThreadCount(0);
    EXPECT_EQ(one.weights, three.weights) << method.name;
    EXPECT_EQ(one.joints, three.joints) << method.name;
  }
}

TEST(WeightMethods, BindPiecesWholeWhereAsked) {
  const TriMesh mesh = testing::join(testing::moved(testing::icosphere(2), {0.5f, 0.1f, 0.1f}, Vec3f::Zero()),
                                     testing::moved(testing::icosphere(1), Vec3f::Constant(0.1f), {0.1f, 0.3f, 0.05f}));
  for (const WeightMethod& method : quickMethods()) {
    SCOPED_TRACE(std::string(method.name));
    WeightOptions options;
    options.pieces = PieceMode::kRigid;
    Progress progress;
    const WeightResult result = method.compute(mesh, bonesHereAndThere(), options, progress);
    for (Index v = 0; v < mesh.vertexCount(); ++v) EXPECT_EQ(result.weights.weightsOf(v)[0], 1);
    EXPECT_EQ(countOf(result.warnings, "rigid-pieces"), 2u);
  }
}

TEST(WeightMethods, RefuseWhatCannotBeBound) {
  const TriMesh ball = testing::icosphere(1);
  Progress progress;
  for (const WeightMethod& method : quickMethods()) {
    SCOPED_TRACE(std::string(method.name));
    WeightOptions options;
    EXPECT_THROW(method.compute(ball, {}, options, progress), Error);
    EXPECT_THROW(method.compute({}, bonesHereAndThere(), options, progress), Error);
    options.maxInfluences = kMaxSlots + 1;
    EXPECT_THROW(method.compute(ball, bonesHereAndThere(), options, progress), Error);
  }
}

}  // namespace
}  // namespace limber
