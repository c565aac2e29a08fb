// Smoothing over a surface by solving, so that a long reach costs no more than a short one.
#pragma once

#include <vector>

#include "limber/deform/smoothing_surface.h"
#include "limber/geometry/solve/sparse_cholesky.h"

namespace limber {

// x -> (I + lambda L)^-times x with L = stiffness / diagonal, the surface's normalised Laplacian (Le, Lewis 2019,
// section 3): means whose weights are not negative and sum to 1, of a mean squared distance of times * lambda steps.
class ImplicitSmoother {
 public:
  static constexpr int kColumns = SparseCholesky::kColumns;

  // Factors once. Keeps the surface, which must outlive it.
  ImplicitSmoother(const SmoothingSurface& surface, double lambda, int times);

  // x: #S rows of kColumns; that of a vertex begins at rowOf(vertex). The first `columns` are smoothed.
  void smooth(std::vector<double>& x, int columns) const;
  std::size_t rowOf(Index vertex) const { return std::size_t{kColumns} * cholesky_.rowOf(vertex); }

 private:
  const SmoothingSurface& surface_;
  SparseCholesky cholesky_;
  int times_;
};

}  // namespace limber
