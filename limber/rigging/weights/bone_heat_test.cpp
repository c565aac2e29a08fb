// Bone heat against a dense solve, and what must hold of its weights on any mesh.
#include "limber/rigging/weights/bone_heat.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/rigging/weights/heat_solver.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::catalogue;
using testing::countOf;
using testing::NamedMesh;

Bone segment(Index joint, const Vec3& a, const Vec3& b) {
  return {joint, a, b, 0};
}

Bone ball(Index joint, const Vec3& centre, double radius) {
  return {joint, centre, centre, radius};
}

// Bones here and there, not all inside.
std::vector<Bone> someBones() {
  return {segment(0, {-0.4, 0, 0}, {-0.1, 0.02, 0}), segment(1, {-0.1, 0.02, 0}, {0.2, 0, 0.03}),
          segment(3, {0.2, 0, 0.03}, {0.45, 0.1, 0}), ball(4, {0.1, 0.3, 0.05}, 0.08), ball(2, {-0.2, -0.25, 0}, 0.1)};
}

double weightOf(const SkinWeights& weights, Index vertex, Index joint) {
  double sum = 0;
  for (Index k = 0; k < weights.slots; ++k) {
    if (weights.jointsOf(vertex)[k] == joint) sum += weights.weightsOf(vertex)[k];
  }
  return sum;
}

WeightResult weightsOf(const TriMesh& mesh, std::span<const Bone> bones, Index maxInfluences = 4) {
  Progress progress;
  return boneHeatWeights(mesh, bones, {maxInfluences}, progress);
}

// What SkinWeights promises.
void expectWellFormed(const SkinWeights& weights, Index vertexCount, Index jointCount) {
  ASSERT_EQ(weights.vertexCount(), vertexCount);
  for (Index v = 0; v < vertexCount; ++v) {
    double sum = 0;
    for (Index k = 0; k < weights.slots; ++k) {
      const float w = weights.weightsOf(v)[k];
      EXPECT_GE(w, 0);
      EXPECT_LE(w, 1);
      EXPECT_LT(weights.jointsOf(v)[k], jointCount);
      EXPECT_TRUE(k == 0 || w <= weights.weightsOf(v)[k - 1]);
      EXPECT_TRUE(w > 0 || weights.jointsOf(v)[k] == 0u);
      for (Index other = 0; other < k; ++other) {
        EXPECT_TRUE(w == 0 || weights.jointsOf(v)[k] != weights.jointsOf(v)[other]) << "joint named twice";
      }
      sum += w;
    }
    EXPECT_NEAR(sum, 1, 1e-6) << v;
  }
}

class BoneHeatCatalogue : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(BoneHeatCatalogue, EveryVertexGetsItsWeights) {
  for (const Index influences : {1u, 4u, 8u}) {
    const WeightResult result = weightsOf(GetParam().mesh, someBones(), influences);
    EXPECT_EQ(result.weights.slots, influences);
    expectWellFormed(result.weights, GetParam().mesh.vertexCount(), 5);
  }
}

TEST_P(BoneHeatCatalogue, WeightsStayInRangeAndSumToOneBeforeAnyCut) {
  const Eigen::MatrixXd full = fullBoneHeat({}, GetParam().mesh, someBones());
  EXPECT_GT(full.minCoeff(), -1e-9);
  EXPECT_LT(full.maxCoeff(), 1 + 1e-9);
  for (int v = 0; v < full.rows(); ++v) {
    const double sum = full.row(v).sum();
    EXPECT_NEAR(sum, sum == 0 ? 0 : 1, 1e-8) << v;  // 0 in pieces that see no bone
  }
}

TEST_P(BoneHeatCatalogue, SameBitsForAnyNumberOfThreads) {
  setThreadCount(1);
  const WeightResult one = weightsOf(GetParam().mesh, someBones());
  setThreadCount(3);
  const WeightResult three = weightsOf(GetParam().mesh, someBones());
  setThreadCount(0);
  EXPECT_EQ(one.weights.joints, three.weights.joints);
  EXPECT_EQ(one.weights.weights, three.weights.weights);
}

TEST_P(BoneHeatCatalogue, MultigridGivesTheWeightsOfTheFactorisation) {
  BoneHeatOptions multigrid;
  multigrid.directBelow = 16;
  const Eigen::MatrixXd full = fullBoneHeat(multigrid, GetParam().mesh, someBones());
  EXPECT_LT((full - fullBoneHeat({}, GetParam().mesh, someBones())).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_GE(full.minCoeff(), 0);
  EXPECT_LE(full.maxCoeff(), 1 + 1e-3);
}

TEST(BoneHeat, MultigridGivesTheSameBitsForAnyNumberOfThreads) {
  BoneHeatOptions multigrid;
  multigrid.directBelow = 16;
  const TriMesh mesh = testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero());
  setThreadCount(1);
  const Eigen::MatrixXd one = fullBoneHeat(multigrid, mesh, someBones());
  setThreadCount(3);
  const Eigen::MatrixXd three = fullBoneHeat(multigrid, mesh, someBones());
  setThreadCount(0);
  EXPECT_EQ(one, three);
}

TEST(HeatSolver, WhatMultigridDoesNotSettleIsFactored) {
  const TriMesh mesh = testing::moved(testing::icosphere(3), Vec3f::Constant(0.5f), Vec3f::Zero());
  const HeatSources sources = findHeatSources(mesh, someBones(), nullptr, {});
  int made = 0;
  const auto makeLaplacian = [&] {
    ++made;
    return robustLaplacian(mesh, vertexComponents(mesh));
  };
  HeatSolver factored(makeLaplacian, mesh.vertexCount());
  HeatSolver neverSettled(makeLaplacian, 16, -1);
  factored.factorize(sources);
  neverSettled.factorize(sources);
  EXPECT_EQ(neverSettled.all(5), factored.all(5));
  EXPECT_EQ(made, 3);
}

INSTANTIATE_TEST_SUITE_P(, BoneHeatCatalogue, ::testing::ValuesIn(catalogue()), testing::MeshName());

// ---- An independent bone heat: dense, brute force, plain cotangents ----

double distanceTo(const Bone& bone, const Vec3& p, Vec3* nearest) {
  // Ternary search: the distance to a segment is convex along it.
  double lo = 0, hi = 1;
  for (int i = 0; i < 200; ++i) {
    const double a = lo + (hi - lo) / 3, b = hi - (hi - lo) / 3;
    const auto at = [&](double s) { return (bone.a + s * (bone.b - bone.a) - p).norm(); };
    (at(a) < at(b) ? hi : lo) = at(a) < at(b) ? b : a;
  }
  *nearest = bone.a + 0.5 * (lo + hi) * (bone.b - bone.a);
  return (*nearest - p).norm();
}

bool crossesSurface(const TriMesh& mesh, Index vertex, const Vec3& to) {
  const Vec3 from = mesh.position(vertex);
  for (const Triangle& t : mesh.triangles) {
    if (t[0] == vertex || t[1] == vertex || t[2] == vertex) continue;
    Eigen::Matrix3d m;
    m << mesh.position(t[1]) - mesh.position(t[0]), mesh.position(t[2]) - mesh.position(t[0]), from - to;
    if (std::abs(m.determinant()) < 1e-12) continue;  // in the triangle's plane
    const Vec3 x = m.fullPivLu().solve(from - mesh.position(t[0]));
    if (x[0] >= 0 && x[1] >= 0 && x[0] + x[1] <= 1 && x[2] > 1e-4 && x[2] < 1 - 1e-4) return true;
  }
  return false;
}

Eigen::MatrixXd denseBoneHeat(const TriMesh& mesh, const std::vector<Bone>& bones, Index jointCount) {
  const Index n = mesh.vertexCount();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n), b = Eigen::MatrixXd::Zero(n, jointCount);
  Eigen::VectorXd area = Eigen::VectorXd::Zero(n);
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index i = t[(k + 1) % 3], j = t[(k + 2) % 3];
      const Vec3 u = mesh.position(i) - mesh.position(t[k]), v = mesh.position(j) - mesh.position(t[k]);
      const double cotangent = u.dot(v) / u.cross(v).norm();
      a(i, j) -= 0.5 * cotangent;
      a(j, i) -= 0.5 * cotangent;
      a(i, i) += 0.5 * cotangent;
      a(j, j) += 0.5 * cotangent;
      area[i] += cotangent * (u - v).squaredNorm() / 8;  // Meyer and others 2003, equation 7
      area[j] += cotangent * (u - v).squaredNorm() / 8;
    }
  }
  for (Index v = 0; v < n; ++v) {
    std::vector<Vec3> nearest(bones.size());
    std::vector<double> distance(bones.size());
    for (std::size_t k = 0; k < bones.size(); ++k) distance[k] = distanceTo(bones[k], mesh.position(v), &nearest[k]);
    const double least = *std::min_element(distance.begin(), distance.end());
    for (std::size_t k = 0; k < bones.size(); ++k) {
      if (distance[k] > least * (1 + 1e-4) || crossesSurface(mesh, v, nearest[k])) continue;
      b(v, bones[k].joint) = area[v] / (least * least);  // once for each joint
    }
  }
  a.diagonal() += b.rowwise().sum();
  return a.fullPivLu().solve(b);
}

TEST(BoneHeat, AgreesWithADenseSolve) {
  const std::vector<Bone> bones = {
      segment(0, {-0.45, 0.01, 0}, {-0.2, 0, 0}), segment(1, {-0.2, 0, 0}, {0.1, 0.02, 0.01}),
      segment(2, {0.1, 0.02, 0.01}, {0.4, 0, 0}), segment(2, {0.1, 0.02, 0.01}, {0.4, 0, 0.09})};
  for (const TriMesh& mesh :
       {testing::tube(14, 23, true), testing::moved(testing::icosphere(2), {0.5f, 0.48f, 0.49f}, Vec3f::Zero())}) {
    HeatSourceOptions plain;
    plain.heat = 1;
    plain.facing = false;
    const Eigen::MatrixXd weights = fullBoneHeat({.sources = plain}, mesh, bones);
    EXPECT_LT((weights - denseBoneHeat(mesh, bones, 3)).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(BoneHeat, TubeBendsWhereItsBonesMeet) {
  const TriMesh tube = testing::tube(16, 41, true);
  const Bone bones[] = {segment(0, {-0.5, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.5, 0, 0})};
  const SkinWeights weights = weightsOf(tube, bones).weights;
  double before = 2;
  for (int ring = 0; ring < 41; ++ring) {
    const Index v = static_cast<Index>(16 * ring);
    const double w = weightOf(weights, v, 0);
    EXPECT_LE(w, before + 1e-6) << "falls along the tube";
    before = w;
    for (Index around = 1; around < 16; ++around) EXPECT_NEAR(weightOf(weights, v + around, 0), w, 2e-3);
  }
  EXPECT_NEAR(weightOf(weights, 16 * 20, 0), 0.5, 1e-5);
  EXPECT_GT(weightOf(weights, 16 * 8, 0), 0.95);
}

TEST(BoneHeat, MirroredBonesGiveMirroredWeights) {
  const TriMesh mesh = testing::moved(testing::icosphere(3), {0.5f, 0.25f, 0.3f}, Vec3f::Zero());
  const Bone bones[] = {segment(0, {0, -0.1, 0}, {0, 0.1, 0}), segment(1, {-0.2, 0, 0}, {-0.4, 0.05, 0.1}),
                        segment(2, {0.2, 0, 0}, {0.4, 0.05, 0.1})};
  const SkinWeights weights = weightsOf(mesh, bones).weights;
  std::size_t pairs = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3f mirrored = mesh.positions[v].cwiseProduct(Vec3f(-1, 1, 1));
    for (Index w = 0; w < mesh.vertexCount(); ++w) {
      if ((mesh.positions[w] - mirrored).norm() > 1e-6f) continue;
      EXPECT_NEAR(weightOf(weights, v, 1), weightOf(weights, w, 2), 1e-4);
      EXPECT_NEAR(weightOf(weights, v, 0), weightOf(weights, w, 0), 1e-4);
      ++pairs;
    }
  }
  EXPECT_EQ(pairs, mesh.vertexCount());
}

TEST(BoneHeat, BonesOfOneJointActAsOne) {
  const TriMesh tube = testing::tube(12, 21, true);
  const Bone whole[] = {segment(0, {-0.5, 0, 0}, {-0.1, 0, 0}), segment(1, {-0.1, 0, 0}, {0.5, 0, 0})};
  const Bone parts[] = {segment(0, {-0.5, 0, 0}, {-0.3, 0, 0}), segment(0, {-0.3, 0, 0}, {-0.1, 0, 0}),
                        segment(1, {-0.1, 0, 0}, {0.5, 0, 0})};
  EXPECT_LT((fullBoneHeat({}, tube, whole) - fullBoneHeat({}, tube, parts)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(BoneHeat, TheNearerSphereIsTheOneWhoseSurfaceIsNearer) {
  // The big sphere's surface reaches farther than halfway, though the small one's centre is nearer there.
  const TriMesh tube = testing::tube(12, 41, true);
  const Bone bones[] = {ball(0, {-0.3, 0, 0}, 0.3), ball(1, {0.3, 0, 0}, 0.05)};
  const SkinWeights weights = weightsOf(tube, bones).weights;
  EXPECT_GT(weightOf(weights, 12 * 22, 0), 0.5);  // at x = 0.05
  EXPECT_GT(weightOf(weights, 12 * 36, 1), 0.9);  // at x = 0.4
}

TEST(BoneHeat, HeatKeepsWeightsNearTheirBones) {
  const TriMesh tube = testing::tube(12, 41, true);
  const Bone bones[] = {segment(0, {-0.5, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.5, 0, 0})};
  double before = 1;
  for (const double heat : {0.25, 1.0, 4.0}) {
    BoneHeatOptions options;
    options.sources.heat = heat;
    const double across = fullBoneHeat(options, tube, bones)(12 * 24, 0);  // at x = 0.1, on the other bone's side
    EXPECT_LT(across, before);
    before = across;
  }
}

TEST(BoneHeat, AWallHidesTheNearerBone) {
  // Two tubes side by side, a bone in each: what is near the neighbour's bone still follows its own.
  const TriMesh mesh = testing::join(testing::tube(24, 21, true),
                                     testing::moved(testing::tube(24, 21, true), Vec3f::Ones(), {0, 0.21f, 0}));
  const Bone bones[] = {segment(0, {-0.4, -0.08, 0}, {0.4, -0.08, 0}), segment(1, {-0.4, 0.13, 0}, {0.4, 0.13, 0})};
  const SkinWeights weights = weightsOf(mesh, bones).weights;
  const Index half = mesh.vertexCount() / 2;
  for (Index v = 0; v < half; ++v) {
    EXPECT_GT(weightOf(weights, v, 0), 0.99);
    EXPECT_GT(weightOf(weights, v + half, 1), 0.99);
  }
}

TEST(BoneHeat, FacesThatLookTheWrongWayDoNotMatter) {
  const TriMesh tube = testing::tube(14, 23, true);
  TriMesh turned = tube;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][2]);
  const std::vector<Bone> bones = someBones();
  EXPECT_LT((fullBoneHeat({}, tube, bones) - fullBoneHeat({}, turned, bones)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(BoneHeat, PiecesThatSeeNoBoneFollowTheNearestOneThatDoes) {
  const TriMesh body = testing::tube(16, 31, true);
  const TriMesh button = testing::moved(testing::icosphere(1), Vec3f::Constant(0.02f), {0.3f, 0.13f, 0});
  TriMesh mesh = testing::join(body, button);
  mesh.positions.push_back({-0.4f, 0.2f, 0});  // and a vertex of no triangle
  const Bone bones[] = {segment(0, {-0.5, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.5, 0, 0})};
  const WeightResult result = weightsOf(mesh, bones);
  std::vector<Index> expected(button.vertexCount() + 1u);
  std::iota(expected.begin(), expected.end(), body.vertexCount());
  EXPECT_EQ(result.bridged, expected);
  for (Index v = body.vertexCount(); v + 1 < mesh.vertexCount(); ++v) EXPECT_GT(weightOf(result.weights, v, 1), 0.95);
  EXPECT_GT(weightOf(result.weights, mesh.vertexCount() - 1, 0), 0.99);
}

TEST(BoneHeat, NothingIsBridgedOnAWholeBody) {
  const Bone bones[] = {segment(0, {-0.5, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.5, 0, 0})};
  const WeightResult result = weightsOf(testing::tube(16, 31, true), bones);
  EXPECT_TRUE(result.bridged.empty());
  EXPECT_TRUE(result.warnings.empty());
}

TEST(BoneHeat, WithEveryBoneHiddenTheNearestCounts) {
  // Six great triangles wall in the bones, and each hides them from the corners of the others.
  TriMesh walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float at : {-0.05f, 0.05f}) {
      for (const Vec3f& corner : {Vec3f(at, -9, -8), Vec3f(at, 9, -8), Vec3f(at, 0, 10)}) {
        walls.positions.push_back({corner[(3 - axis) % 3], corner[(4 - axis) % 3], corner[(5 - axis) % 3]});
      }
      const Index last = walls.vertexCount();
      walls.triangles.push_back({last - 3, last - 2, last - 1});
    }
  }
  const Bone bones[] = {ball(0, {-0.01, 0, 0}, 0.001), ball(1, {0.01, 0, 0}, 0.001)};
  const WeightResult result = weightsOf(walls, bones);
  EXPECT_EQ(countOf(result.warnings, "no-bone-in-sight"), 1u);
  expectWellFormed(result.weights, walls.vertexCount(), 2);
}

TEST(BoneHeat, ThousandsOfPieces) {
  TriMesh mesh = testing::moved(testing::icosphere(2), Vec3f::Constant(0.5f), Vec3f::Zero());
  const TriMesh chip{{{0, 0, 0}, {0.01f, 0, 0}, {0, 0.01f, 0}}, {{0, 1, 2}}};
  for (int i = 0; i < 3000; ++i) {
    const double z = 1 - (2 * i + 1) / 3000.0, turn = 2.399963 * i, r = 0.52 * std::sqrt(1 - z * z);
    mesh = testing::join(std::move(mesh),
                         testing::moved(chip, Vec3f::Ones(),
                                        {static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
                                         static_cast<float>(0.52 * z)}));
  }
  const Bone bones[] = {segment(0, {-0.3, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.3, 0, 0})};
  const WeightResult result = weightsOf(mesh, bones);
  expectWellFormed(result.weights, mesh.vertexCount(), 2);
  EXPECT_EQ(result.bridged.size(), 9000u);
}

TEST(BoneHeat, OneBoneTakesAll) {
  const Bone bones[] = {segment(2, {-0.1, 0, 0}, {0.1, 0, 0})};
  const SkinWeights weights = weightsOf(testing::tube(8, 5, true), bones).weights;
  for (Index v = 0; v < weights.vertexCount(); ++v) EXPECT_EQ(weightOf(weights, v, 2), 1);
}

TEST(BoneHeat, BonesOnTheSurfaceItself) {
  const TriMesh grid = testing::moved(testing::flatGrid(10, 10), Vec3f::Ones(), {-0.5f, -0.5f, 0});
  const Bone bones[] = {segment(0, {-0.5, -0.5, 0}, {-0.5, 0.5, 0}), segment(1, {0.5, -0.5, 0}, {0.5, 0.5, 0})};
  const Eigen::MatrixXd full = fullBoneHeat({}, grid, bones);
  EXPECT_NEAR(full(0, 0), 1, 1e-6);
  EXPECT_NEAR(full(5, 0), 0.5, 1e-3);
  EXPECT_NEAR(full(10, 1), 1, 1e-6);
}

TEST(BoneHeat, FaintInfluencesFadeOut) {
  const TriMesh tube = testing::tube(12, 41, true);
  const Bone bones[] = {segment(0, {-0.5, 0, 0}, {0, 0, 0}), segment(1, {0, 0, 0}, {0.5, 0, 0})};
  const SkinWeights weights = weightsOf(tube, bones).weights;
  const Eigen::MatrixXd full = fullBoneHeat({}, tube, bones);
  int gone = 0, kept = 0;
  for (Index v = 0; v < tube.vertexCount(); ++v) {
    if (full(v, 1) < 0.025) {
      EXPECT_EQ(weightOf(weights, v, 1), 0);
      ++gone;
    }
    if (full.row(v).minCoeff() > 0.05) {
      EXPECT_NEAR(weightOf(weights, v, 1), full(v, 1), 1e-6);
      ++kept;
    }
  }
  EXPECT_GT(gone, 0);
  EXPECT_GT(kept, 0);
}

TEST(BoneHeat, RefusesWhatMakesNoSense) {
  const TriMesh tube = testing::tube(8, 5, true);
  const std::vector<Bone> bones = someBones();
  EXPECT_THROW(weightsOf(tube, {}), Error);
  EXPECT_THROW(weightsOf(tube, bones, 0), Error);
  EXPECT_THROW(weightsOf(tube, bones, 9), Error);
  EXPECT_THROW(weightsOf(TriMesh{tube.positions, {}}, bones), Error);
}

TEST(BoneHeat, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  try {
    boneHeatWeights(testing::tube(8, 5, true), someBones(), {}, progress);
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  }
}

}  // namespace
}  // namespace limber
