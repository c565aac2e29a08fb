// A symmetric positive definite matrix whose entries lie near the diagonal, and least squares that make one.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace limber {

class BandMatrix {
 public:
  // n x n, entries at most `width` columns left of the diagonal. All zero at first. A band of blocks has a panel for
  // each column of blocks, `panel` columns of the matrix: none of them has entries more than `width` rows below the
  // panel's first diagonal entry. That is faster to solve.
  explicit BandMatrix(std::size_t n, std::size_t width, std::size_t panel = 1)
      : n_(n), width_(width), panel_(panel), entries_(n * (width + 1), 0.0) {}

  void clear() { entries_.assign(entries_.size(), 0.0); }
  // The entries of another of this size, each so often.
  void addScaled(const BandMatrix& other, double factor);

  // Of the lower triangle: column <= row, and row - column <= width.
  double& at(std::size_t row, std::size_t column) { return entries_[column * width_ + row]; }

  // The whole matrix times a column of n values.
  std::vector<double> times(const std::vector<double>& column) const;
  // Overwrites the right-hand side (n values) with the solution, and the matrix with its Cholesky factor, n * width^2
  // operations. The matrix has to be positive definite.
  void solve(std::vector<double>& right);

 private:
  void factor();
  void substitute(std::vector<double>& right) const;

  std::size_t n_, width_, panel_;
  std::vector<double> entries_;  // column by column, each from the diagonal down
};

// The n unknowns with the least sum of squares, each of some unknowns that are at most `width` apart.
class BandLeastSquares {
 public:
  struct Term {
    std::size_t unknown = 0;
    double factor = 0;
  };
  // `panel` as for BandMatrix.
  BandLeastSquares(std::size_t n, std::size_t width, std::size_t panel = 1)
      : matrix_(n, width, panel), right_(n, 0.0) {}

  void clear();
  // The sums of another of this size, each so often.
  void addScaled(const BandLeastSquares& other, double factor);
  // weight * (sum of the terms - value)^2
  void add(std::span<const Term> terms, double value, double weight);
  // The normal equations, for sums that come in blocks.
  BandMatrix& matrix() { return matrix_; }
  std::vector<double>& right() { return right_; }
  // Every unknown has to be in some sum. Overwrites the sums.
  std::vector<double> solve();

 private:
  BandMatrix matrix_;
  std::vector<double> right_;
};

}  // namespace limber
