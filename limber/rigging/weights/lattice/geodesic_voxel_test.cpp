// Path lengths in a box, where they have a closed form, and round the gap of a horseshoe.
#include "limber/rigging/weights/lattice/geodesic_voxel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/bone_distance.h"
#include "limber/rigging/weights/lattice/inside_lattice.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::countOf;

Bone point(Index joint, const Vec3& at) {
  return {joint, at, at, 0};
}

double pullOf(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.jointsOf(vertex)[k] == joint) sum += weights.weightsOf(vertex)[k];
  }
  return sum;
}

WeightResult voxelWeightsOf(const TriMesh& mesh, const std::vector<Bone>& bones, double falloff = 0.2) {
  Progress progress;
  GeodesicVoxelOptions voxels;
  voxels.falloff = falloff;
  return geodesicVoxelWeightsWith(voxels, mesh, bones, {}, progress);
}

// The length of the shortest path in a grid whose steps are 10, 14 and 17 tenths, in its spacings.
double chamferDistance(const Vec3& between) {
  std::array<double, 3> along = {std::abs(between.x()), std::abs(between.y()), std::abs(between.z())};
  std::sort(along.begin(), along.end());
  return 1.7 * along[0] + 1.4 * (along[1] - along[0]) + along[2] - along[1];
}

TEST(GeodesicVoxel, AFarBitMakesNoCellsLarger) {
  const TriMesh ball = testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero());
  const std::vector<Bone> bones = {point(0, {-0.25, 0, 0}), point(1, {0.2, 0.1, 0})};
  TriMesh both = ball;
  const Index first = both.vertexCount();
  for (const Vec3f& corner : {Vec3f(80, 0, 0), Vec3f(80, 0.01f, 0), Vec3f(80, 0, 0.01f)}) {
    both.positions.push_back(corner);
  }
  both.triangles.push_back({first, first + 1, first + 2});
  const SkinWeights alone = voxelWeightsOf(ball, bones).weights, weights = voxelWeightsOf(both, bones).weights;
  for (Index v = 0; v < first; ++v) EXPECT_EQ(pullOf(weights, v, 0), pullOf(alone, v, 0)) << v;
  EXPECT_NEAR(pullOf(weights, first, 0) + pullOf(weights, first, 1), 1, 1e-6);
}

TEST(GeodesicVoxel, WaysInAConvexBodyAreStraight) {
  const TriMesh ball = testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero());
  const std::array<Vec3, 2> at = {Vec3(-0.25, 0, 0), Vec3(0.2, 0.1, 0)};
  for (const double falloff : {0.0, 1.0}) {
    const SkinWeights weights = voxelWeightsOf(ball, {point(0, at[0]), point(1, at[1])}, falloff).weights;
    for (Index v = 0; v < ball.vertexCount(); ++v) {
      std::array<double, 2> pull;
      for (int j = 0; j < 2; ++j) {
        const double pathLength = 100 * chamferDistance(ball.position(v) - at[j]);
        pull[j] = 1 / std::pow((1 - falloff) * pathLength + falloff * pathLength * pathLength, 2);
      }
      // Seeds and vertices lie up to half a cell from where they count.
      EXPECT_NEAR(pullOf(weights, v, 0), pull[0] / (pull[0] + pull[1]), 0.08) << v << " " << falloff;
    }
  }
}

// Two arms side by side, joined at their lower ends: near to each other, and far.
struct Horseshoe {
  TriMesh mesh;
  std::vector<Bone> bones;

  Horseshoe() {
    const TriMesh column = testing::moved(testing::icosphere(3), {0.08f, 0.45f, 0.08f}, Vec3f::Zero());
    mesh = testing::join(testing::moved(column, Vec3f::Ones(), {-0.12f, 0.05f, 0}),
                         testing::moved(column, Vec3f::Ones(), {0.12f, 0.05f, 0}));
    mesh = testing::join(mesh, testing::moved(testing::icosphere(3), {0.22f, 0.08f, 0.09f}, {0, -0.4f, 0}));
    for (const Index joint : {0u, 1u}) {
      const double x = joint == 0 ? -0.12 : 0.12;
      bones.push_back({joint, {x, 0, 0}, {x, 0.4, 0}, 0});
    }
  }
};

TEST(GeodesicVoxel, NoWeightLeapsAGap) {
  const Horseshoe horseshoe;
  const SkinWeights voxels = voxelWeightsOf(horseshoe.mesh, horseshoe.bones).weights;
  Progress progress;
  const SkinWeights envelopes = envelopeWeights(horseshoe.mesh, horseshoe.bones, {}, progress).weights;
  double worst = 0, worstEnvelope = 0;
  for (Index v = 0; v < horseshoe.mesh.vertexCount(); ++v) {
    const Vec3 position = horseshoe.mesh.position(v);
    if (position.y() < 0.1) continue;
    const Index other = position.x() < 0 ? 1 : 0;
    worst = std::max(worst, pullOf(voxels, v, other));
    worstEnvelope = std::max(worstEnvelope, pullOf(envelopes, v, other));
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(worstEnvelope, 0.02) << "what lies between does not stop them";
}

TEST(GeodesicVoxel, FacesThatAreTurnedOrOpenChangeLittle) {
  const Horseshoe horseshoe;
  const SkinWeights whole = voxelWeightsOf(horseshoe.mesh, horseshoe.bones).weights;
  TriMesh open = horseshoe.mesh;
  for (std::size_t t = 0; t < open.triangles.size(); t += 7) std::swap(open.triangles[t][0], open.triangles[t][1]);
  for (std::size_t t = 0; t < open.triangles.size(); t += 50) open.triangles.erase(open.triangles.begin() + t);
  const SkinWeights other = voxelWeightsOf(open, horseshoe.bones).weights;
  double sum = 0;
  for (Index v = 0; v < whole.vertexCount(); ++v) sum += std::abs(pullOf(whole, v, 0) - pullOf(other, v, 0));
  EXPECT_LT(sum / whole.vertexCount(), 0.05);
}

// The shortest paths of a small lattice by rounds over all its edges (Bellman, Ford), and weights from these.
TEST(GeodesicVoxel, WaysAreTheShortestInTheLattice) {
  const Horseshoe horseshoe;
  GeodesicVoxelOptions voxels;
  voxels.maxCells = 24;
  Progress progress;
  const SkinWeights weights = geodesicVoxelWeightsWith(voxels, horseshoe.mesh, horseshoe.bones, {}, progress).weights;

  InsideLattice lattice(horseshoe.mesh, InsideQueries(horseshoe.mesh), 24);
  std::array<std::vector<Index>, 2> seeds;
  for (int j = 0; j < 2; ++j) seeds[j] = lattice.cellsAlong(horseshoe.bones[j]);
  std::array<std::vector<double>, 2> distances;
  for (int j = 0; j < 2; ++j) {
    distances[j].assign(lattice.cellCount(), 1e9);
    for (const Index cell : seeds[j]) distances[j][cell] = 0;
    for (bool shorter = true; shorter;) {
      shorter = false;
      for (Index cell = 0; cell < lattice.cellCount(); ++cell) {
        for (int n = 0; n < 27; ++n) {
          const int x = n % 3 - 1, y = n / 3 % 3 - 1, z = n / 9 - 1, axes = std::abs(x) + std::abs(y) + std::abs(z);
          const Index next = lattice.neighbor(cell, lattice.step(x, y, z));
          const double pathLength = distances[j][cell] + (axes == 1 ? 1 : axes == 2 ? 1.4 : 1.7);
          if (axes == 0 || next == kNoIndex || pathLength > distances[j][next] - 1e-9) continue;
          distances[j][next] = pathLength;
          shorter = true;
        }
      }
    }
  }
  for (Index v = 0; v < horseshoe.mesh.vertexCount(); ++v) {
    std::array<Index, 8> cells;
    std::array<double, 8> parts;
    const int count = lattice.cellsRound(horseshoe.mesh.position(v), cells, parts);
    std::array<double, 2> pull;
    for (int j = 0; j < 2; ++j) {
      double all = 0, sum = 0;
      for (int i = 0; i < count; ++i) {
        all += parts[i];
        sum += parts[i] * distances[j][cells[i]];
      }
      const double d = 100 * lattice.spacing() * std::max(0.5, sum / all), far = 0.8 * d + 0.2 * d * d;
      pull[j] = 1 / (far * far);
    }
    EXPECT_NEAR(pullOf(weights, v, 0), pull[0] / (pull[0] + pull[1]), 1e-5) << v;
  }
}

TEST(GeodesicVoxel, PiecesThatNoWayLeadsToTakeTheNearestWeights) {
  Horseshoe horseshoe;
  const Index body = horseshoe.mesh.vertexCount();
  horseshoe.mesh =
      testing::join(horseshoe.mesh, testing::moved(testing::icosphere(1), Vec3f::Constant(0.02f), {0.3f, 0.3f, 0}));
  const WeightResult result = voxelWeightsOf(horseshoe.mesh, horseshoe.bones);
  EXPECT_EQ(result.bridged.size(), horseshoe.mesh.vertexCount() - body);
  for (Index v = body; v < horseshoe.mesh.vertexCount(); ++v) EXPECT_GT(pullOf(result.weights, v, 1), 0.9);
}

TEST(GeodesicVoxel, BonesThatReachNothingLeaveTheNearest) {
  const TriMesh ball = testing::icosphere(2);
  const WeightResult result = voxelWeightsOf(ball, {point(0, {-9, 0, 0}), point(1, {9, 0, 0})});
  EXPECT_EQ(countOf(result.warnings, "no-bone-in-sight"), 1u);
  for (Index v = 0; v < ball.vertexCount(); ++v) {
    const double x = ball.position(v).x();
    if (std::abs(x) < 0.01) continue;
    EXPECT_EQ(pullOf(result.weights, v, x > 0 ? 1 : 0), 1);
  }
}

}  // namespace
}  // namespace limber
