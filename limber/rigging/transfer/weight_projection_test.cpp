#include "limber/rigging/transfer/weight_projection.h"

#include <gmock/gmock.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {

namespace {

// By height: joint 0 below, joint 1 above.
SkinWeights weightsByHeight(const TriMesh& mesh) {
  SkinWeights weights;
  weights.slots = 2;
  for (const Vec3f& p : mesh.positions) {
    const float upper = 0.5f * (p.y() + 1);
    weights.joints.insert(weights.joints.end(), {1, 0});
    weights.weights.insert(weights.weights.end(), {upper, 1 - upper});
  }
  return weights;
}

double weightIn(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index slot = 0; slot < weights.slots; ++slot) {
    if (weights.jointsOf(vertex)[slot] == joint) sum += weights.weightsOf(vertex)[slot];
  }
  return sum;
}

TEST(WeightProjectionTest, AreLinearOverATriangle) {
  const TriMesh sphere = testing::icosphere(2), fine = testing::cutInFour(sphere);
  const SkinWeights weights = projectWeights(sphere, weightsByHeight(sphere), takenAfter(sphere, fine), 2);
  for (Index v = 0; v < fine.vertexCount(); ++v) {
    ASSERT_NEAR(weightIn(weights, v, 1), 0.5 * (fine.position(v).y() + 1), 1e-5);
    ASSERT_NEAR(weightIn(weights, v, 0) + weightIn(weights, v, 1), 1, 1e-6);
    ASSERT_GE(weights.weightsOf(v)[0], weights.weightsOf(v)[1]);
  }
}

// Two thin plates side by side, one joint each: a plate that lies a little off keeps to the side that it faces with.
TEST(WeightProjectionTest, DoesNotTakeFromWhatFacesAway) {
  const TriMesh left = testing::moved(testing::icosphere(3), {0.05f, 1, 1}, {0, 0, 0});
  const TriMesh right = testing::moved(testing::icosphere(3), {0.05f, 1, 1}, {0.11f, 0, 0});
  const TriMesh both = testing::join(left, right);
  SkinWeights weights;
  weights.slots = 1;
  for (Index v = 0; v < both.vertexCount(); ++v) {
    weights.joints.push_back(v < left.vertexCount() ? 0 : 1);
    weights.weights.push_back(1);
  }
  const TriMesh target = testing::moved(both, {1, 1, 1}, {0.02f, 0, 0});
  const SkinWeights result = projectWeights(both, weights, takenAfter(both, target), 1);
  int wrong = 0;
  for (Index v = 0; v < target.vertexCount(); ++v) wrong += result.jointsOf(v)[0] != (v < left.vertexCount() ? 0u : 1u);
  EXPECT_LT(wrong, 0.02 * target.vertexCount());
}

TEST(WeightProjectionTest, FillsUpWhatHasNone) {
  const TriMesh sphere = testing::icosphere(2);
  SkinWeights weights = weightsByHeight(sphere);
  for (Index v = 0; v < sphere.vertexCount(); ++v) {
    if (sphere.position(v).x() > 0.3) weights.weights[2 * v] = weights.weights[2 * v + 1] = 0;
  }
  const SkinWeights result = projectWeights(sphere, weights, takenAfter(sphere, sphere), 4);
  for (Index v = 0; v < sphere.vertexCount(); ++v)
    ASSERT_NEAR(weightIn(result, v, 0) + weightIn(result, v, 1), 1, 1e-5);
}

TEST(WeightProjectionTest, RefusesASurfaceWithoutAny) {
  const TriMesh sphere = testing::icosphere(1);
  SkinWeights weights = weightsByHeight(sphere);
  std::fill(weights.weights.begin(), weights.weights.end(), 0.0f);
  EXPECT_THROW(projectWeights(sphere, weights, takenAfter(sphere, sphere), 4), Error);
}

}  // namespace

}  // namespace limber
