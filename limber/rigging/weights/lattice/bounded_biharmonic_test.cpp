// Bars with a closed form, and what weights must be in every body: local, without maxima between bones.
#include "limber/rigging/weights/lattice/bounded_biharmonic.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::countOf;

double weightAt(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.jointsOf(vertex)[k] == joint) sum += weights.weightsOf(vertex)[k];
  }
  return sum;
}

WeightResult smoothWeightsOf(const TriMesh& mesh, const std::vector<Bone>& bones, double cells = 1500) {
  Progress progress;
  BoundedBiharmonicOptions options;
  options.cells = cells;
  return boundedBiharmonicWeightsWith(options, mesh, bones, {}, progress);
}

// Two discs through a bar, as bones across it; between them the weights of a beam.
TEST(BoundedBiharmonic, BetweenTwoClampedEndsIsTheCubic) {
  const TriMesh bar = testing::moved(testing::tube(16, 41, true), {1, 0.4f, 0.4f}, Vec3f::Zero());
  // Each end is pinned across its whole width: the slope along the bar is 0 there.
  std::vector<Bone> bones;
  for (const double y : {-0.03, -0.015, 0.0, 0.015, 0.03}) {
    for (const double z : {-0.03, -0.015, 0.0, 0.015, 0.03}) {
      bones.push_back({0, {-0.55, y, z}, {-0.3, y, z}, 0});
      bones.push_back({1, {0.3, y, z}, {0.55, y, z}, 0});
    }
  }
  std::sort(bones.begin(), bones.end(), [](const Bone& a, const Bone& b) { return a.joint < b.joint; });
  const SkinWeights weights = smoothWeightsOf(bar, bones).weights;
  for (Index v = 0; v < bar.vertexCount(); ++v) {
    const double t = std::clamp((bar.position(v).x() + 0.3) / 0.6, 0.0, 1.0);
    EXPECT_NEAR(weightAt(weights, v, 1), t * t * (3 - 2 * t), 0.04) << bar.position(v).x();
  }
}

// Three bones along a tube, which touch.
struct Limb {
  TriMesh mesh = testing::tube(16, 61, true);
  std::vector<Bone> bones = {
      {0, {-0.45, 0, 0}, {-0.15, 0, 0}, 0}, {1, {-0.15, 0, 0}, {0.15, 0, 0}, 0}, {2, {0.15, 0, 0}, {0.45, 0, 0}, 0}};
};

TEST(BoundedBiharmonic, FallsAlongALimbAndReachesNoFurtherThanTheNextBone) {
  const Limb limb;
  const SkinWeights weights = smoothWeightsOf(limb.mesh, limb.bones, 3000).weights;
  for (int column = 0; column < 16; ++column) {
    double last = 1.01;
    for (int ring = 0; ring < 61; ++ring) {
      const auto v = static_cast<Index>(ring * 16 + column);
      const double x = limb.mesh.position(v).x(), first = weightAt(weights, v, 0);
      EXPECT_LE(first, last + 0.01) << x;  // no maximum in between
      last = first;
      if (x < -0.35) {
        EXPECT_GT(first, 0.97) << x;
      }
      if (x > 0.1) {
        EXPECT_LT(first, 0.02) << x;
      }
    }
  }
}

TEST(BoundedBiharmonic, MirrorImagesHaveMirroredWeights) {
  const Limb limb;
  const SkinWeights weights = smoothWeightsOf(limb.mesh, limb.bones).weights;
  for (int ring = 0; ring < 61; ++ring) {
    for (int column = 0; column < 16; ++column) {
      const auto v = static_cast<Index>(ring * 16 + column), image = static_cast<Index>((60 - ring) * 16 + column);
      EXPECT_NEAR(weightAt(weights, v, 0), weightAt(weights, image, 2), 0.02);
    }
  }
}

TEST(BoundedBiharmonic, CrossesNoGap) {
  const TriMesh column = testing::moved(testing::icosphere(3), {0.08f, 0.45f, 0.08f}, Vec3f::Zero());
  TriMesh mesh = testing::join(testing::moved(column, Vec3f::Ones(), {-0.18f, 0.05f, 0}),
                               testing::moved(column, Vec3f::Ones(), {0.18f, 0.05f, 0}));
  mesh = testing::join(mesh, testing::moved(testing::icosphere(3), {0.28f, 0.08f, 0.09f}, {0, -0.4f, 0}));
  const std::vector<Bone> bones = {{0, {-0.18, 0, 0}, {-0.18, 0.4, 0}, 0}, {1, {0.18, 0, 0}, {0.18, 0.4, 0}, 0}};
  const SkinWeights weights = smoothWeightsOf(mesh, bones, 3000).weights;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3 position = mesh.position(v);
    if (position.y() > 0.1) {
      EXPECT_LT(weightAt(weights, v, position.x() < 0 ? 1 : 0), 0.01);
    }
  }
}

TEST(BoundedBiharmonic, ASheetIsBoundAsABodyIs) {
  const TriMesh sheet = testing::moved(testing::flatGrid(24, 8), {1, 0.3f, 1}, {-0.5f, -0.15f, 0});
  const SkinWeights weights =
      smoothWeightsOf(sheet, {{0, {-0.45, 0, 0}, {0, 0, 0}, 0}, {1, {0, 0, 0}, {0.45, 0, 0}, 0}}).weights;
  for (Index v = 0; v < sheet.vertexCount(); ++v) {
    const double x = sheet.position(v).x();
    if (std::abs(x) > 0.3) {
      EXPECT_GT(weightAt(weights, v, x < 0 ? 0 : 1), 0.95) << x;
    }
  }
}

TEST(BoundedBiharmonic, BallsCountByTheirCentres) {
  const TriMesh ball = testing::moved(testing::icosphere(3), {0.5f, 0.2f, 0.2f}, Vec3f::Zero());
  const std::vector<Bone> points = {{0, {-0.3, 0, 0}, {-0.3, 0, 0}, 0}, {1, {0.3, 0, 0}, {0.3, 0, 0}, 0}};
  std::vector<Bone> balls = points;
  for (Bone& bone : balls) bone.radius = 0.15;
  EXPECT_EQ(smoothWeightsOf(ball, points).weights.weights, smoothWeightsOf(ball, balls).weights.weights);
}

TEST(BoundedBiharmonic, PiecesThatNoBoneReachesTakeTheNearestWeights) {
  Limb limb;
  const Index body = limb.mesh.vertexCount();
  limb.mesh = testing::join(limb.mesh, testing::moved(testing::icosphere(1), Vec3f::Constant(0.02f), {-0.3f, 0.3f, 0}));
  const WeightResult result = smoothWeightsOf(limb.mesh, limb.bones);
  EXPECT_EQ(result.bridged.size(), limb.mesh.vertexCount() - body);
  for (Index v = body; v < limb.mesh.vertexCount(); ++v) EXPECT_GT(weightAt(result.weights, v, 0), 0.9);
}

TEST(BoundedBiharmonic, BonesThatReachNothingLeaveTheNearest) {
  const TriMesh ball = testing::icosphere(2);
  const WeightResult result = smoothWeightsOf(ball, {{0, {-9, 0, 0}, {-9, 0, 0}, 0}, {1, {9, 0, 0}, {9, 0, 0}, 0}});
  EXPECT_EQ(countOf(result.warnings, "no-bone-in-sight"), 1u);
}

TEST(BoundedBiharmonic, StopsWhenItIsCancelled) {
  const Limb limb;
  Progress progress;
  progress.cancel();
  EXPECT_THROW(boundedBiharmonicWeights(limb.mesh, limb.bones, {}, progress), Error);
}

}  // namespace
}  // namespace limber
