// A symmetric positive definite matrix whose entries lie near the diagonal.
#pragma once

#include <cstddef>
#include <vector>

namespace limber {

class BandMatrix {
 public:
  // n x n, entries at most `width` columns left of the diagonal. All zero at first.
  BandMatrix(std::size_t n, std::size_t width) : n_(n), width_(width), entries_(n * (width + 1), 0.0) {}

  // Of the lower triangle: column <= row, and row - column <= width.
  double& at(std::size_t row, std::size_t column) { return entries_[row * (width_ + 1) + width_ + column - row]; }

  // The whole matrix times a column of n values.
  std::vector<double> times(const std::vector<double>& column) const;
  // Overwrites the right-hand side (n values) with the solution, and the matrix with its Cholesky factor, n * width^2
  // operations. The matrix has to be positive definite.
  void solve(std::vector<double>& right);

 private:
  std::size_t n_, width_;
  std::vector<double> entries_;  // row by row, the diagonal last
};

}  // namespace limber
