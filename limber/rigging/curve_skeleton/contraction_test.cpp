#include "limber/rigging/curve_skeleton/contraction.h"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/solve/laplacian.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

std::vector<Vec3> positionsOf(const TriMesh& mesh) {
  std::vector<Vec3> positions;
  for (Index v = 0; v < mesh.vertexCount(); ++v) positions.push_back(mesh.position(v));
  return positions;
}

TEST(Contraction, OfOneStepIsWhatADenseLeastSquaresGives) {
  testing::TestRandom random(5);
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    if (mesh.vertexCount() > 130) continue;
    SCOPED_TRACE(name);
    const Laplacian laplacian = robustLaplacian(mesh, vertexComponents(mesh));
    std::vector<double> attraction;
    for (Index v = 0; v < mesh.vertexCount(); ++v) attraction.push_back(0.5 + random.unit());
    const double smoothing = 3;
    // Both kinds of rows stacked, solved by QR and not by normal equations.
    const Eigen::Index size = mesh.vertexCount();
    const Eigen::MatrixXd lower = laplacian.stiffness;
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * size, size), right = Eigen::MatrixXd::Zero(2 * size, 3);
    rows.topRows(size) = smoothing * Eigen::MatrixXd(lower.selfadjointView<Eigen::Lower>());
    for (Eigen::Index v = 0; v < size; ++v) {
      rows(size + v, v) = attraction[v];
      right.row(size + v) = attraction[v] * mesh.position(static_cast<Index>(v)).transpose();
    }
    const Eigen::MatrixXd expected = rows.colPivHouseholderQr().solve(right);
    const std::vector<Vec3> solved = contractedOnce(positionsOf(mesh), laplacian.stiffness, smoothing, attraction);
    for (Eigen::Index v = 0; v < size; ++v) {
      EXPECT_LT((solved[v] - Vec3(expected.row(v).transpose())).norm(), 1e-6 * (1 + solved[v].norm())) << v;
    }
  }
}

TEST(Contraction, TakesEveryMeshAndShrinksIt) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    Progress progress;
    const std::vector<Vec3> contracted = contractSurface(mesh, progress);
    ASSERT_EQ(contracted.size(), mesh.positions.size());
    Box before, after;
    for (const Vec3& p : positionsOf(mesh)) before.add(p);
    for (const Vec3& p : contracted) {
      ASSERT_TRUE(p.allFinite());
      after.add(p);
    }
    EXPECT_LE(after.diagonal(), 1.01 * before.diagonal() + 1e-9);
  }
}

TEST(Contraction, OfABallIsNearItsMiddle) {
  Progress progress;
  for (const Vec3& p : contractSurface(testing::ball(4), progress)) EXPECT_LT(p.norm(), 0.25);
}

TEST(Contraction, VerticesWithoutTrianglesStay) {
  TriMesh mesh = testing::ball(2);
  mesh.positions.push_back({3, 4, 5});
  Progress progress;
  EXPECT_LT((contractSurface(mesh, progress).back() - Vec3(3, 4, 5)).norm(), 1e-9);
}

}  // namespace

}  // namespace limber
