// Coarser forms of a matrix over a surface: neighbouring unknowns become one.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "limber/core/types.h"

namespace limber {

// A sparse matrix by rows; columns ascend in each.
struct SparseRows {
  Index columnCount = 0;
  std::vector<std::size_t> first = {0};  // #rows + 1
  std::vector<Index> column;
  std::vector<double> value;

  Index rowCount() const { return static_cast<Index>(first.size() - 1); }
};

// #V x #V; only the lower triangle of the symmetric matrix is read.
SparseRows rowsOf(const Eigen::SparseMatrix<double>& lower);
Eigen::SparseMatrix<double> lowerTriangle(const SparseRows& symmetric);

// Unknowns from neighbour to neighbour, piece after piece, so that what belongs together is close in memory.
std::vector<Index> breadthFirst(const SparseRows& matrix);

// Row r is that of unknown order[r], and so are columns.
SparseRows reordered(const SparseRows& matrix, const std::vector<Index>& order);

// Smoothed aggregation (Vanek, Mandel, Brezina: Algebraic Multigrid by Smoothed Aggregation for Second and Fourth Order
// Elliptic Problems, 1996). `prolong` has a row for each unknown, which sums to 1: what it takes from the coarser ones;
// `matrix` is transpose(prolong) * the finer matrix * prolong.
struct CoarserMatrix {
  SparseRows prolong;
  SparseRows matrix;
};

// A link is strong where its square is at least strongLinks^2 times the product of the diagonals of its two unknowns in
// the Laplacian part. Nothing where that would hardly leave fewer unknowns.
//
// matrix  a Laplacian with weights that are not negative, plus a diagonal that is not; or a coarser form of such
// Cost: O(entries).
std::optional<CoarserMatrix> coarserMatrix(const SparseRows& matrix, double strongLinks);

}  // namespace limber
