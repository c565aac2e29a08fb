#include "limber/retarget/band_matrix.h"

#include <algorithm>
#include <cmath>

namespace limber {

std::vector<double> BandMatrix::times(const std::vector<double>& column) const {
  std::vector<double> result(n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i) {
    const double* row = &entries_[i * (width_ + 1)];
    result[i] += row[width_] * column[i];
    for (std::size_t back = 1; back <= std::min(width_, i); ++back) {
      result[i] += row[width_ - back] * column[i - back];
      result[i - back] += row[width_ - back] * column[i];
    }
  }
  return result;
}

void BandMatrix::solve(std::vector<double>& right) {
  const auto begin = [&](std::size_t row) { return row > width_ ? row - width_ : 0; };
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t j = begin(i); j <= i; ++j) {
      double sum = at(i, j);
      const std::size_t from = std::max(begin(i), begin(j));
      for (std::size_t k = from; k < j; ++k) sum -= at(i, k) * at(j, k);
      at(i, j) = j < i ? sum / at(j, j) : std::sqrt(sum);
    }
  }
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = begin(i); k < i; ++k) right[i] -= at(i, k) * right[k];
    right[i] /= at(i, i);
  }
  for (std::size_t i = n_; i-- > 0;) {
    right[i] /= at(i, i);
    for (std::size_t k = begin(i); k < i; ++k) right[k] -= at(i, k) * right[i];
  }
}

void BandLeastSquares::add(std::span<const Term> terms, double value, double weight) {
  for (const Term& one : terms) {
    right_[one.unknown] += weight * one.factor * value;
    for (const Term& other : terms) {
      if (other.unknown <= one.unknown) matrix_.at(one.unknown, other.unknown) += weight * one.factor * other.factor;
    }
  }
}

std::vector<double> BandLeastSquares::solve() const {
  BandMatrix matrix = matrix_;
  std::vector<double> result = right_;
  matrix.solve(result);
  return result;
}

}  // namespace limber
