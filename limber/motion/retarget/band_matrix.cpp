#include "limber/motion/retarget/band_matrix.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace limber {

namespace {

// Columns of a factor, `stride` apart.
struct Columns {
  const double* first;
  std::size_t stride, count;
};

// Some rows of a column, less those of `columns` times `factors`, one for each (as far apart). In registers: a column
// is read and written once.
template <int kRows>
inline void subtractRows(const Columns& columns, std::size_t row, const double* factors, double* column) {
  using Rows = Eigen::Array<double, kRows, 1>;
  Rows rows = Eigen::Map<const Rows>(column + row);
  for (std::size_t i = 0; i < columns.count * columns.stride; i += columns.stride) {
    rows -= factors[i] * Eigen::Map<const Rows>(columns.first + i + row);
  }
  Eigen::Map<Rows>(column + row) = rows;
}

// Column `j` of the matrix less what the columns before it in its factor have of it, in the rows from `j` up to `end`.
void subtractColumns(const Columns& columns, std::size_t j, std::size_t end, double* column) {
  const double* factors = columns.first + j;
  std::size_t row = j;
  for (; row + 16 <= end; row += 16) subtractRows<16>(columns, row, factors, column);
  if (row + 8 <= end) {
    subtractRows<8>(columns, row, factors, column);
    row += 8;
  }
  if (row + 4 <= end) {
    subtractRows<4>(columns, row, factors, column);
    row += 4;
  }
  if (row + 2 <= end) {
    subtractRows<2>(columns, row, factors, column);
    row += 2;
  }
  if (row < end) subtractRows<1>(columns, row, factors, column);
}

}  // namespace

void BandMatrix::addScaled(const BandMatrix& other, double factor) {
  for (std::size_t i = 0; i < entries_.size(); ++i) entries_[i] += factor * other.entries_[i];
}

std::vector<double> BandMatrix::times(const std::vector<double>& column) const {
  std::vector<double> result(n_, 0.0);
  for (std::size_t j = 0; j < n_; ++j) {
    const double* entries = &entries_[j * width_];
    result[j] += entries[j] * column[j];
    for (std::size_t i = j + 1; i < std::min(n_, j + width_ + 1); ++i) {
      result[i] += entries[i] * column[j];
      result[j] += entries[i] * column[i];
    }
  }
  return result;
}

void BandMatrix::solve(std::vector<double>& right) {
  factor();
  substitute(right);
}

// Panel by panel: what the panels above have of each column, then what the panel's own columns before it have. Entries
// below the last row are there, and stay zero. The factor's diagonal is kept as its inverse.
void BandMatrix::factor() {
  const std::size_t reach = width_ / panel_;  // panels
  for (std::size_t begin = 0; begin < n_; begin += panel_) {
    const std::size_t end = begin + width_ + 1;
    for (std::size_t j = begin; j < std::min(n_, begin + panel_); ++j) {
      double* column = &entries_[j * width_];
      for (std::size_t above = begin - std::min(begin, reach * panel_); above < begin; above += panel_) {
        subtractColumns({&entries_[above * width_], width_, panel_}, j, above + width_ + 1, column);
      }
      subtractColumns({&entries_[begin * width_], width_, j - begin}, j, end, column);
      const double inverse = 1 / std::sqrt(column[j]);
      column[j] = inverse;
      for (std::size_t row = j + 1; row < end; ++row) column[row] *= inverse;
    }
  }
}

void BandMatrix::substitute(std::vector<double>& right) const {
  for (std::size_t j = 0; j < n_; ++j) {
    const double* column = &entries_[j * width_];
    right[j] *= column[j];
    const double value = right[j];
    for (std::size_t i = j + 1; i < std::min(n_, j + width_ + 1); ++i) right[i] -= column[i] * value;
  }
  // From the far end on: the last of these is the one that has just been found.
  for (std::size_t j = n_; j-- > 0;) {
    const double* column = &entries_[j * width_];
    std::array<double, 4> sums = {right[j], 0, 0, 0};
    std::size_t i = std::min(n_, j + width_ + 1);
    for (; i >= j + 5; i -= 4) {
      for (std::size_t k = 0; k < 4; ++k) sums[k] -= column[i - 4 + k] * right[i - 4 + k];
    }
    for (; i > j + 1; --i) sums[0] -= column[i - 1] * right[i - 1];
    right[j] = ((sums[0] + sums[1]) + (sums[2] + sums[3])) * column[j];
  }
}

void BandLeastSquares::clear() {
  matrix_.clear();
  right_.assign(right_.size(), 0.0);
}

void BandLeastSquares::addScaled(const BandLeastSquares& other, double factor) {
  matrix_.addScaled(other.matrix_, factor);
  for (std::size_t i = 0; i < right_.size(); ++i) right_[i] += factor * other.right_[i];
}

void BandLeastSquares::add(std::span<const Term> terms, double value, double weight) {
  for (const Term& one : terms) {
    right_[one.unknown] += weight * one.factor * value;
    for (const Term& other : terms) {
      if (other.unknown <= one.unknown) matrix_.at(one.unknown, other.unknown) += weight * one.factor * other.factor;
    }
  }
}

std::vector<double> BandLeastSquares::solve() {
  matrix_.solve(right_);
  return right_;
}

}  // namespace limber
