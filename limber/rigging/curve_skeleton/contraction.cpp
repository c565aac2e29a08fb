#include "limber/rigging/curve_skeleton/contraction.h"

#include <algorithm>
#include <cmath>

#include "limber/core/grouped.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/solve/laplacian.h"
#include "limber/geometry/solve/sparse_cholesky.h"

namespace limber {

namespace {

// Of the whole area: its root is the length over which the first step smooths. Beginning 16 times smaller with the
// paper's growth of 2 takes twelve steps where these take six, and leaves the ends of tubes 40 times as thick.
constexpr double kFirstSmoothing = 4e-3;
constexpr double kGrowth = 3;

struct MatrixEntry {
  int column;
  double value;
};

// Rows of a symmetric matrix that is given by its lower triangle.
Grouped<MatrixEntry> symmetricRows(const Eigen::SparseMatrix<double>& lower) {
  return {static_cast<std::size_t>(lower.cols()), [&](const auto& visit) {
            for (int c = 0; c < lower.cols(); ++c) {
              for (int k = lower.outerIndexPtr()[c]; k < lower.outerIndexPtr()[c + 1]; ++k) {
                const int row = lower.innerIndexPtr()[k];
                visit(row, {c, lower.valuePtr()[k]});
                if (row != c) visit(c, {row, lower.valuePtr()[k]});
              }
            }
          }};
}

// The lower triangle of factor^2 L L + diagonal^2.
Eigen::SparseMatrix<double> normalMatrix(const Grouped<MatrixEntry>& l, double factor,
                                         const std::vector<double>& diagonal) {
  const int size = static_cast<int>(diagonal.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  std::vector<int> rows;
  std::vector<double> values;
  std::vector<double> sum(diagonal.size(), 0);
  std::vector<char> isMet(diagonal.size(), 0);
  std::vector<int> met;
  for (int c = 0; c < size; ++c) {
    met.assign(1, c);
    isMet[c] = 1;
    sum[c] = diagonal[c] * diagonal[c];
    for (const MatrixEntry& left : l.of(c)) {
      for (const auto& [row, value] : l.of(left.column)) {
        if (row < c) continue;
        if (!isMet[row]) met.push_back(row);
        isMet[row] = 1;
        sum[row] += factor * factor * left.value * value;
      }
    }
    std::sort(met.begin(), met.end());
    for (const int row : met) {
      rows.push_back(row);
      values.push_back(sum[row]);
      isMet[row] = 0;
      sum[row] = 0;
    }
    matrix.outerIndexPtr()[c + 1] = static_cast<int>(rows.size());
  }
  matrix.resizeNonZeros(static_cast<Eigen::Index>(rows.size()));
  std::copy(rows.begin(), rows.end(), matrix.innerIndexPtr());
  std::copy(values.begin(), values.end(), matrix.valuePtr());
  return matrix;
}

}  // namespace

std::vector<Vec3> contractedOnce(const std::vector<Vec3>& positions, const Eigen::SparseMatrix<double>& stiffness,
                                 double smoothing, const std::vector<double>& attraction) {
  const Eigen::SparseMatrix<double> matrix = normalMatrix(symmetricRows(stiffness), smoothing, attraction);
  SparseCholesky cholesky(matrix);
  cholesky.factorize(matrix);
  constexpr int kColumns = SparseCholesky::kColumns;
  std::vector<double> x(positions.size() * kColumns, 0);
  const auto row = [&](std::size_t v) {
    return x.data() + std::size_t{cholesky.rowOf(static_cast<Index>(v))} * kColumns;
  };
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (int i = 0; i < 3; ++i) row(v)[i] = attraction[v] * attraction[v] * positions[v][i];
  }
  cholesky.solve(x.data(), 3);
  std::vector<Vec3> contracted(positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) contracted[v] = Vec3(row(v)[0], row(v)[1], row(v)[2]);
  return contracted;
}

std::vector<Vec3> contractSurface(const TriMesh& mesh, Progress& progress) {
  const std::vector<Index> piece = vertexComponents(mesh);
  TriMesh shrunken = mesh;
  std::vector<Vec3> positions;
  for (Index v = 0; v < mesh.vertexCount(); ++v) positions.push_back(mesh.position(v));
  Eigen::VectorXd firstMass;
  double smoothing = kFirstSmoothing * mesh.vertexCount();
  for (int step = 0; step < kMaxContractions; ++step, smoothing *= kGrowth) {
    progress.update(static_cast<double>(step) / kMaxContractions);
    const Laplacian laplacian = robustLaplacian(shrunken, piece);
    if (step == 0) firstMass = laplacian.mass;
    if (laplacian.mass.sum() <= kContracted * firstMass.sum()) break;
    std::vector<double> attraction(positions.size(), 1);
    for (std::size_t v = 0; v < attraction.size(); ++v) {
      // Rounding makes areas below this meaningless.
      const double least = 1e-8 * firstMass[v];
      if (firstMass[v] > 0) attraction[v] = std::sqrt(firstMass[v] / std::max(laplacian.mass[v], least));
    }
    positions = contractedOnce(positions, laplacian.stiffness, smoothing, attraction);
    for (std::size_t v = 0; v < positions.size(); ++v) shrunken.positions[v] = positions[v].cast<float>();
  }
  return positions;
}

}  // namespace limber
