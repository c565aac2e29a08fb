// The plan of a sparse factorisation: in which order unknowns are eliminated, and which of them together.
#pragma once

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "limber/core/types.h"

namespace limber {

// Unknowns that are eliminated as one dense block: positions `begin` to `end` in the order. Eliminating them changes
// the later positions `rows`, ascending. A front's children are those whose first row is one of its own positions.
struct FrontPlan {
  Index begin = 0, end = 0;
  std::vector<Index> rows;
  std::vector<Index> children;  // ascending, all less than the front's own number

  Index ownCount() const { return end - begin; }
};

// The entries of a permuted symmetric matrix, each in the column of the position that comes first.
struct PermutedEntries {
  std::vector<int> first;     // #V + 1
  std::vector<Index> row;     // of each entry's row, never before the column's
  std::vector<int> position;  // of its value in the matrix given
};

struct FrontTree {
  std::vector<Index> positionOf;  // #V: where in the order each unknown comes
  std::vector<FrontPlan> fronts;  // children before parents
  PermutedEntries entries;
};

// Orders by approximate minimum degree (Amestoy, Davis, Duff 1996), then along the elimination tree (Liu 1990), whose
// columns are gathered into fronts: small subtrees whole, and chains as long as that adds few zeros.
//
// lower  #V x #V, only the lower triangle is read
FrontTree planFronts(const Eigen::SparseMatrix<double>& lower);

}  // namespace limber
