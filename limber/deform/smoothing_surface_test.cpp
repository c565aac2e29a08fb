// What delta mush smooths over, and smoothing by solving against the dense inverse.
#include "limber/deform/smoothing_surface.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "limber/deform/implicit_smoother.h"
#include "limber/deform/testing/bent_tube.h"

namespace limber {
namespace {

using testing::bentTube;
using testing::BoundMesh;

SmoothingSurface surfaceOf(const BoundMesh& bound) {
  return smoothingSurface(bound.surface());
}

TEST(SmoothingSurface, WeldsWhatIsBoundAlike) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, -0.0f, 0}, {0, 0, 1}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}};
  const SkinWeights weights = {2, {0, 1, 0, 1, 0, 1, 1, 0, 1, 0, 0, 1}, {1, 0, .6f, .4f, 1, 0, .6f, .4f, 1, 0, 1, 0}};
  const SmoothingSurface surface = smoothingSurface({positions, triangles, weights});
  // Vertices 1 and 3 have most in common; 0 and 4 follow different joints.
  EXPECT_EQ(surface.weldedVertex, (std::vector<Index>{0, 1, 2, 1, 3, 4}));
  EXPECT_EQ(surface.vertexCount(), 5u);
  EXPECT_EQ(surface.positions[3], positions[4]);
}

TEST(SmoothingSurface, WalksAsFarOverAnyTriangles) {
  const auto openTube = [](int around, int rings) {
    BoundMesh bound = bentTube(around, rings, 0.2, Quat::Identity());
    bound.mesh.triangles.resize(bound.mesh.triangles.size() - static_cast<std::size_t>(2 * around));
    return bound;
  };
  const SmoothingSurface coarse = surfaceOf(openTube(16, 41)), fine = surfaceOf(openTube(32, 81));
  EXPECT_NEAR(coarse.meanSquaredStep / fine.meanSquaredStep, 4, 0.1);
  EXPECT_NEAR(fine.stepsFor(0.1) / coarse.stepsFor(0.1), 4, 0.1);
  EXPECT_EQ(coarse.stepsFor(1e-6), 1);
  BoundMesh large = openTube(16, 41);
  for (Vec3f& p : large.mesh.positions) p *= 100.0f;
  EXPECT_NEAR(surfaceOf(large).stepsFor(0.1) / coarse.stepsFor(0.1), 1, 1e-3);
}

TEST(SmoothingSurface, WithoutTrianglesEveryVertexStandsAlone) {
  BoundMesh bound = bentTube(6, 5, 0.2, Quat::Identity());
  for (const std::vector<Triangle>& none : {std::vector<Triangle>{}, std::vector<Triangle>{{0, 0, 1}}}) {
    bound.mesh.triangles = none;
    const SmoothingSurface surface = surfaceOf(bound);
    EXPECT_EQ(surface.vertexCount(), bound.mesh.vertexCount());
    EXPECT_EQ(surface.stiffness.norm(), 0);
    EXPECT_EQ(surface.diagonal.minCoeff(), 1);
    EXPECT_EQ(surface.stepsFor(0.1), 1);
  }
}

TEST(ImplicitSmoother, IsTheDensePower) {
  constexpr double kLambda = 3;
  constexpr int kTimes = 4;
  const SmoothingSurface surface = surfaceOf(testing::boundAtRandom(testing::soup(40, 60, 3)));
  const Eigen::Index count = surface.vertexCount();
  Eigen::MatrixXd once = Eigen::MatrixXd(surface.stiffness);
  once.triangularView<Eigen::StrictlyUpper>() = once.transpose();
  for (Eigen::Index v = 0; v < count; ++v) once.row(v) *= kLambda / surface.diagonal[v];
  once += Eigen::MatrixXd::Identity(count, count);
  Eigen::MatrixXd wanted(count, 2);
  const ImplicitSmoother smoother(surface, kLambda, kTimes);
  std::vector<double> x(static_cast<std::size_t>(count) * ImplicitSmoother::kColumns);
  for (Index v = 0; v < count; ++v) {
    wanted.row(v) << v % 7, 1;
    x[smoother.rowOf(v)] = v % 7;
    x[smoother.rowOf(v) + 1] = 1;
  }
  for (int i = 0; i < kTimes; ++i) wanted = once.fullPivLu().solve(wanted).eval();
  smoother.smooth(x, 2);
  for (Index v = 0; v < count; ++v) {
    EXPECT_NEAR(x[smoother.rowOf(v)], wanted(v, 0), 1e-9) << v;
    EXPECT_NEAR(x[smoother.rowOf(v) + 1], 1, 1e-12) << v;
  }
}

}  // namespace
}  // namespace limber
