// The factorisation against Eigen's dense one, over matrices of many shapes.
#include "limber/geometry/solve/sparse_cholesky.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

#include "limber/core/parallel.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/testing/shapes.h"
#include "limber/geometry/solve/front_kernels.h"
#include "limber/geometry/solve/laplacian.h"

namespace limber {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

// The lower triangle of a Laplacian with something on its diagonal.
Sparse surfaceMatrix(const TriMesh& mesh, double diagonal) {
  Sparse matrix = robustLaplacian(mesh, vertexComponents(mesh)).stiffness;
  for (int i = 0; i < matrix.cols(); ++i) matrix.coeffRef(i, i) += diagonal;
  return matrix;
}

// Random entries, made positive definite by a heavy diagonal.
Sparse randomMatrix(int size, int entries, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < entries; ++i) {
    const int a = static_cast<int>(random() % static_cast<unsigned>(size));
    const int b = static_cast<int>(random() % static_cast<unsigned>(size));
    if (a != b) dense(std::max(a, b), std::min(a, b)) = value(random);
  }
  const Eigen::MatrixXd both = dense.selfadjointView<Eigen::Lower>();
  dense.diagonal() = both.cwiseAbs().rowwise().sum().array() + 0.1;
  Sparse result = dense.sparseView();
  return result;
}

// Solves for some right-hand sides; the solution's columns are those of the right-hand sides.
Eigen::MatrixXd solve(const SparseCholesky& cholesky, const Eigen::MatrixXd& right) {
  std::vector<double> x(static_cast<std::size_t>(right.rows()) * SparseCholesky::kColumns, 0.0);
  const auto at = [&](Eigen::Index row, Eigen::Index column) -> double& {
    return x[cholesky.rowOf(static_cast<Index>(row)) * std::size_t{SparseCholesky::kColumns} +
             static_cast<std::size_t>(column)];
  };
  for (Eigen::Index i = 0; i < right.rows(); ++i) {
    for (Eigen::Index j = 0; j < right.cols(); ++j) at(i, j) = right(i, j);
  }
  cholesky.solve(x.data(), static_cast<int>(right.cols()));
  Eigen::MatrixXd result(right.rows(), right.cols());
  for (Eigen::Index i = 0; i < right.rows(); ++i) {
    for (Eigen::Index j = 0; j < right.cols(); ++j) result(i, j) = at(i, j);
  }
  return result;
}

void expectSolves(const Sparse& matrix) {
  SparseCholesky cholesky(matrix);
  EXPECT_EQ(cholesky.factorize(matrix), 0u);
  const Eigen::MatrixXd dense = Eigen::MatrixXd(matrix).selfadjointView<Eigen::Lower>();
  const Eigen::LLT<Eigen::MatrixXd> reference(dense);
  for (const int columns : {1, 4, 5, 8}) {
    std::srand(columns);
    const Eigen::MatrixXd right = Eigen::MatrixXd::Random(matrix.cols(), columns);
    const Eigen::MatrixXd expected = reference.solve(right);
    EXPECT_LT((solve(cholesky, right) - expected).cwiseAbs().maxCoeff(), 1e-10 * (1 + expected.cwiseAbs().maxCoeff()));
  }
}

class CholeskyCatalogue : public ::testing::TestWithParam<testing::NamedMesh> {};

TEST_P(CholeskyCatalogue, AgreesWithDenseCholesky) {
  expectSolves(surfaceMatrix(GetParam().mesh, 0.1));
}

INSTANTIATE_TEST_SUITE_P(, CholeskyCatalogue, ::testing::ValuesIn(testing::catalogue()), testing::MeshName());

TEST(SparseCholesky, RandomMatricesOfAnyDensity) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const int size = 1 + static_cast<int>(seed * 7 % 90);
    expectSolves(randomMatrix(size, static_cast<int>(seed * seed % 400), seed));
  }
}

TEST(SparseCholesky, DenseChainStarAndDiagonal) {
  expectSolves(randomMatrix(70, 20000, 1));
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(300, 300), star = chain;
  chain.diagonal().setConstant(2.1);
  chain.diagonal(-1).setConstant(-1);
  expectSolves(chain.sparseView());
  star.diagonal().setConstant(400);
  star.col(0).tail(299).setConstant(-1);
  expectSolves(star.sparseView());
  star.row(299).head(299).setConstant(-1);
  expectSolves(star.sparseView());
  expectSolves(Eigen::MatrixXd(Eigen::VectorXd::LinSpaced(50, 1, 2).asDiagonal()).sparseView());
}

TEST(SparseCholesky, FactorsAgainWithOtherValues) {
  const TriMesh ball = testing::icosphere(2);
  SparseCholesky cholesky(surfaceMatrix(ball, 1));
  for (const double diagonal : {1.0, 5.0}) {
    const Sparse matrix = surfaceMatrix(ball, diagonal);
    cholesky.factorize(matrix);
    const Eigen::MatrixXd x = solve(cholesky, Eigen::MatrixXd::Ones(matrix.cols(), 2));
    EXPECT_LT((x.array() - 1 / diagonal).abs().maxCoeff(), 1e-12);  // constants are in the Laplacian's kernel
  }
}

TEST(SparseCholesky, SameBitsForAnyNumberOfThreads) {
  const Sparse matrix = surfaceMatrix(testing::icosphere(5), 0.01);
  const Eigen::MatrixXd right = Eigen::MatrixXd::Ones(matrix.cols(), 3) + Eigen::MatrixXd::Identity(matrix.cols(), 3);
  std::vector<Eigen::MatrixXd> solutions;
  for (const int threads : {1, 2, 4}) {
    setThreadCount(threads);
    SparseCholesky cholesky(matrix);
    cholesky.factorize(matrix);
    solutions.push_back(solve(cholesky, right));
  }
  setThreadCount(0);
  EXPECT_EQ(solutions[0], solutions[1]);
  EXPECT_EQ(solutions[0], solutions[2]);
  const Eigen::MatrixXd residual = matrix.selfadjointView<Eigen::Lower>() * solutions[0] - right;
  EXPECT_LT(residual.cwiseAbs().maxCoeff(), 1e-8);
}

TEST(SparseCholesky, GatheringColumnsAddsNoMoreThanTheFactorHolds) {
  const Sparse matrix = surfaceMatrix(testing::icosphere(5), 0.01);
  const Eigen::SimplicialLLT<Sparse> columnwise(matrix);
  const Eigen::Index entries = Sparse(columnwise.matrixL()).nonZeros();
  EXPECT_LT(SparseCholesky(matrix).factorEntries(), 2 * static_cast<std::size_t>(entries));
}

TEST(SparseCholesky, RaisesPivotsThatAreNotPositive) {
  Eigen::MatrixXd dense(3, 3);
  dense << 1, 0, 0, -1, 1, 0, 0, 0, 2;  // the first two unknowns only differ: singular
  const Sparse matrix = dense.sparseView();
  SparseCholesky cholesky(matrix);
  EXPECT_EQ(cholesky.factorize(matrix), 1u);
  EXPECT_TRUE(solve(cholesky, Eigen::MatrixXd::Ones(3, 1)).allFinite());
}

TEST(SparseCholesky, NothingToSolve) {
  const Sparse matrix(0, 0);
  SparseCholesky cholesky(matrix);
  EXPECT_EQ(cholesky.factorize(matrix), 0u);
  cholesky.solve(nullptr);
}

TEST(FrontKernels, SameBitsWithAndWithoutAvx2) {
  const FrontKernels* wide = avx2FrontKernels();
  if (!wide) GTEST_SKIP() << "this machine has no AVX2";
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<double> a(4 * 37), b(3 * a.size()), x(16);
  for (std::vector<double>* numbers : {&a, &b, &x}) {
    for (double& number : *numbers) number = value(random);
  }
  for (const std::size_t columns : {0u, 1u, 4u, 37u}) {
    std::vector<double> narrowProducts(48, 0.5), wideProducts = narrowProducts;
    baselineFrontKernels().subtractProducts(a.data(), b.data(), a.size(), 3, columns, narrowProducts.data());
    wide->subtractProducts(a.data(), b.data(), a.size(), 3, columns, wideProducts.data());
    EXPECT_EQ(narrowProducts, wideProducts);
    std::vector<double> narrow = a, broad = a;
    baselineFrontKernels().subtractTransposed(b.data(), x.data(), columns, narrow.data());
    wide->subtractTransposed(b.data(), x.data(), columns, broad.data());
    EXPECT_EQ(narrow, broad);
  }
}

}  // namespace
}  // namespace limber
