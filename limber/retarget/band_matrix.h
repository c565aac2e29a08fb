// A symmetric positive definite matrix whose entries lie near the diagonal, and least squares that make one.
#pragma once

#include <cstddef>
#include <span>
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

// The n unknowns with the least sum of squares, each of some unknowns that are at most `width` apart.
class BandLeastSquares {
 public:
  struct Term {
    std::size_t unknown = 0;
    double factor = 0;
  };
  BandLeastSquares(std::size_t n, std::size_t width) : matrix_(n, width), right_(n, 0.0) {}

  // weight * (sum of the terms - value)^2
  void add(std::span<const Term> terms, double value, double weight);
  // Every unknown has to be in some sum.
  std::vector<double> solve() const;

 private:
  BandMatrix matrix_;
  std::vector<double> right_;
};

}  // namespace limber
