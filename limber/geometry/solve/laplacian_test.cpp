// The Laplacian against what is known of it: its kernel, linear functions, sphere harmonics, the plain cotangent
// formula.
#include "limber/geometry/solve/laplacian.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using testing::catalogue;
using testing::NamedMesh;

Laplacian laplacianOf(const TriMesh& mesh) {
  return robustLaplacian(mesh, vertexComponents(mesh));
}

Eigen::MatrixXd dense(const Laplacian& laplacian) {
  return Eigen::MatrixXd(laplacian.stiffness).selfadjointView<Eigen::Lower>();
}

// Straight from the angles between edge vectors, summed over triangles.
Eigen::MatrixXd plainCotangents(const TriMesh& mesh) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(mesh.vertexCount(), mesh.vertexCount());
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Index i = t[(k + 1) % 3], j = t[(k + 2) % 3];
      const Vec3 u = mesh.position(i) - mesh.position(t[k]), v = mesh.position(j) - mesh.position(t[k]);
      const double weight = 0.5 / std::tan(std::acos(u.normalized().dot(v.normalized())));
      result(i, j) -= weight;
      result(j, i) -= weight;
      result(i, i) += weight;
      result(j, j) += weight;
    }
  }
  return result;
}

double surfaceArea(const TriMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    area += 0.5 * (mesh.position(t[1]) - mesh.position(t[0])).cross(mesh.position(t[2]) - mesh.position(t[0])).norm();
  }
  return area;
}

class LaplacianCatalogue : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(LaplacianCatalogue, ConstantsAreItsKernel) {
  const Eigen::MatrixXd matrix = dense(laplacianOf(GetParam().mesh));
  const double scale = matrix.diagonal().maxCoeff();
  EXPECT_LT(matrix.rowwise().sum().cwiseAbs().maxCoeff(), 1e-12 * scale);
  // And nothing but constants over each piece.
  Index pieces = 0;
  vertexComponents(GetParam().mesh, &pieces);
  const Eigen::VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  EXPECT_GT(eigenvalues[0], -1e-10 * scale);
  EXPECT_LT(eigenvalues[pieces - 1], 1e-10 * scale);
  if (pieces < eigenvalues.size()) {
    EXPECT_GT(eigenvalues[pieces], 1e-9 * scale);
  }
}

TEST_P(LaplacianCatalogue, WeightsAreNotNegative) {
  const Laplacian laplacian = laplacianOf(GetParam().mesh);
  for (int column = 0; column < laplacian.stiffness.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(laplacian.stiffness, column); it; ++it) {
      EXPECT_GE(it.row(), column) << "only the lower triangle is stored";
      EXPECT_TRUE(std::isfinite(it.value()));
      if (it.row() == column) {
        EXPECT_GE(it.value(), 0);
      } else {
        EXPECT_LT(it.value(), 0);
      }
    }
  }
}

TEST_P(LaplacianCatalogue, MassIsTheArea) {
  const Laplacian laplacian = laplacianOf(GetParam().mesh);
  EXPECT_GE(laplacian.mass.minCoeff(), 0);
  const double area = surfaceArea(GetParam().mesh);
  EXPECT_NEAR(laplacian.mass.sum(), area, 1e-3 * area);
}

INSTANTIATE_TEST_SUITE_P(, LaplacianCatalogue, ::testing::ValuesIn(catalogue()), testing::MeshName());

TEST(Laplacian, LinearFunctionsAreHarmonicInsideAFlatGrid) {
  for (const float shake : {0.0f, 0.2f, 0.3f}) {
    const TriMesh grid = testing::flatGrid(12, 12, shake);
    const Eigen::MatrixXd matrix = dense(laplacianOf(grid));
    Eigen::VectorXd f(grid.vertexCount());
    for (Index v = 0; v < grid.vertexCount(); ++v) f[v] = 3 * grid.position(v).x() - 2 * grid.position(v).y() + 0.5;
    const Eigen::VectorXd residual = matrix * f;
    for (Index v = 0; v < grid.vertexCount(); ++v) {
      const Vec3 p = grid.position(v);
      // Next to the border the cover's flips may reach round it, where the pillow is not flat.
      if (std::min(std::min(p.x(), 1 - p.x()), std::min(p.y(), 1 - p.y())) < 0.2) continue;
      EXPECT_NEAR(residual[v], 0, 1e-9) << shake;
    }
    EXPECT_NEAR(f.dot(residual), 13, 1e-2);  // the integral of |grad f|^2 over the unit square
  }
}

TEST(Laplacian, PlainCotangentsOnADelaunaySphere) {
  const TriMesh ball = testing::icosphere(2);
  EXPECT_LT((dense(laplacianOf(ball)) - plainCotangents(ball)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Laplacian, BothSidesOfTheCoverGiveTheSameAsOne) {
  const TriMesh ball = testing::icosphere(2);
  TriMesh turned = ball;
  for (std::size_t t = 0; t < turned.triangles.size(); t += 4)
    std::swap(turned.triangles[t][1], turned.triangles[t][2]);
  EXPECT_LT((dense(laplacianOf(turned)) - dense(laplacianOf(ball))).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Laplacian, PlainCotangentsWithABoundary) {
  const TriMesh grid = testing::tube(16, 9, false);
  EXPECT_LT((dense(laplacianOf(grid)) - plainCotangents(grid)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Laplacian, PlainCotangentsWhereThreeSheetsMeet) {
  const TriMesh book = testing::pages(3);
  EXPECT_LT((dense(laplacianOf(book)) - plainCotangents(book)).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Laplacian, EigenvaluesOfTheSphere) {
  const TriMesh ball = testing::icosphere(3);
  const Laplacian laplacian = laplacianOf(ball);
  const Eigen::VectorXd eigenvalues =
      Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd>(
          dense(laplacian), Eigen::MatrixXd(laplacian.mass.asDiagonal()), Eigen::EigenvaluesOnly)
          .eigenvalues();
  int at = 0;
  for (int l = 0; l <= 3; ++l) {
    for (int m = -l; m <= l; ++m) EXPECT_NEAR(eigenvalues[at++], l * (l + 1), 0.02 * l * (l + 1) + 1e-9) << l;
  }
}

TEST(Laplacian, SphereHarmonicsConverge) {
  double before = 0;
  for (const int level : {2, 3, 4}) {
    const TriMesh ball = testing::icosphere(level);
    const Laplacian laplacian = laplacianOf(ball);
    Eigen::VectorXd f(ball.vertexCount());
    for (Index v = 0; v < ball.vertexCount(); ++v) {
      const Vec3 p = ball.position(v);
      f[v] = p.x() * p.y() + 0.5 * (3 * p.z() * p.z() - 1);  // l = 2
    }
    const Eigen::VectorXd stiff = laplacian.stiffness.selfadjointView<Eigen::Lower>() * f;
    const double error = std::abs(f.dot(stiff) / f.dot(laplacian.mass.cwiseProduct(f)) - 6);
    if (before > 0) {
      EXPECT_LT(error, before / 3.5) << "an error of second order falls to a quarter";
    }
    before = error;
  }
}

TEST(Laplacian, SplittingBadlyShapedTrianglesMattersLittle) {
  // The same square, once in good triangles and once in slivers: the Dirichlet energy of one function must agree.
  const TriMesh slivers = testing::sliveredGrid();
  const Laplacian laplacian = laplacianOf(slivers);
  Eigen::VectorXd f(slivers.vertexCount());
  for (Index v = 0; v < slivers.vertexCount(); ++v) f[v] = slivers.position(v).x();
  const double energy = f.dot(laplacian.stiffness.selfadjointView<Eigen::Lower>() * f);
  EXPECT_NEAR(energy, surfaceArea(slivers), 0.01);
}

TEST(Laplacian, VertexWithoutTrianglesHasARowOfZeros) {
  TriMesh mesh = testing::flatGrid(2, 2);
  mesh.positions.push_back({5, 5, 5});
  const Laplacian laplacian = laplacianOf(mesh);
  EXPECT_EQ(laplacian.stiffness.coeff(9, 9), 0);
  EXPECT_EQ(laplacian.mass[9], 0);
  EXPECT_EQ(laplacian.stiffness.rows(), 10);
}

}  // namespace
}  // namespace limber
