#include "limber/deform/implicit_smoother.h"

namespace limber {

namespace {

// diagonal * (I + lambda L), which is symmetric.
Eigen::SparseMatrix<double> implicitStep(const SmoothingSurface& surface, double lambda) {
  Eigen::SparseMatrix<double> matrix = lambda * surface.stiffness;
  for (int v = 0; v < matrix.cols(); ++v) matrix.coeffRef(v, v) += surface.diagonal[v];
  return matrix;
}

}  // namespace

ImplicitSmoother::ImplicitSmoother(const SmoothingSurface& surface, double lambda, int times)
    : surface_(surface), cholesky_(surface.stiffness), times_(times) {
  cholesky_.factorize(implicitStep(surface, lambda));
}

void ImplicitSmoother::smooth(std::vector<double>& x, int columns) const {
  for (int i = 0; i < times_; ++i) {
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      for (int column = 0; column < columns; ++column) x[rowOf(v) + column] *= surface_.diagonal[v];
    }
    cholesky_.solve(x.data(), columns);
  }
}

}  // namespace limber
