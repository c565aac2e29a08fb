#include "limber/motion/retarget/band_matrix.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <Eigen/Dense>

namespace limber {
namespace {

class BandMatrixTest : public ::testing::TestWithParam<int> {};

// Bands of blocks of that many rows, the first panel's last row being that of a block two further down. The last block
// is cut short.
TEST_P(BandMatrixTest, SolvesAndMultipliesAsADenseMatrixDoes) {
  constexpr int kSize = 40, kReach = 2;
  const int panel = GetParam(), width = (kReach + 1) * panel - 1;
  const auto first = [&](int row) { return std::max(0, (row / panel - kReach) * panel); };
  // A product of a band with its transpose, hence positive definite.
  Eigen::MatrixXd band = Eigen::MatrixXd::Zero(kSize, kSize);
  for (int i = 0; i < kSize; ++i) {
    for (int j = first(i); j <= i; ++j) band(i, j) = i == j ? 3 + std::cos(i) : std::sin(3.0 * i + j);
  }
  const Eigen::MatrixXd dense = band * band.transpose();
  Eigen::VectorXd right(kSize);
  BandMatrix matrix(kSize, static_cast<std::size_t>(width), static_cast<std::size_t>(panel));
  std::vector<double> solution;
  for (int i = 0; i < kSize; ++i) {
    solution.push_back(right[i] = std::sin(1.0 + i));
    for (int j = first(i); j <= i; ++j)
      matrix.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = dense(i, j);
  }
  const std::vector<double> product = matrix.times(solution);
  for (int i = 0; i < kSize; ++i) EXPECT_NEAR(product[static_cast<std::size_t>(i)], dense.row(i) * right, 1e-10);
  matrix.solve(solution);
  const Eigen::VectorXd expected = dense.llt().solve(right);
  for (int i = 0; i < kSize; ++i)
    EXPECT_NEAR(solution[static_cast<std::size_t>(i)], expected[i], 1e-8 * (1 + expected.norm()));
}

INSTANTIATE_TEST_SUITE_P(Panels, BandMatrixTest, ::testing::Values(1, 2, 9, 13));

// Through two points and as straight as can be in between: the line through them.
TEST(BandLeastSquares, FindsTheLeastSum) {
  using Term = BandLeastSquares::Term;
  BandLeastSquares squares(9, 2);
  squares.add(std::array{Term{1, 1}}, 3, 1);
  squares.add(std::array{Term{7, 2}}, 30, 1);
  for (std::size_t i = 2; i < 9; ++i) squares.add(std::array{Term{i, 1}, Term{i - 1, -2}, Term{i - 2, 1}}, 0, 5);
  BandLeastSquares other(9, 2);
  other.clear();
  other.addScaled(squares, 3);
  const std::vector<double> line = squares.solve();
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(line[i], 1 + 2 * static_cast<double>(i), 1e-9);
  other.add(std::array{Term{7, 1}, Term{8, 1}}, 5, 3e12);
  other.add(std::array{Term{8, 1}}, 0, 3e12);
  const std::vector<double> bent = other.solve();
  EXPECT_NEAR(bent[8], 0, 1e-9) << "weights count";
  EXPECT_NEAR(bent[7], 5, 1e-9);
}

}  // namespace
}  // namespace limber
