// Solves large elliptic systems over a surface, several right-hand sides at once, in time and memory that grow with its
// size.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "limber/core/types.h"
#include "limber/geometry/solve/sparse_cholesky.h"

namespace limber {

// Multigrid by smoothed aggregation (Vanek, Mandel, Brezina: Algebraic Multigrid by Smoothed Aggregation for Second and
// Fourth Order Elliptic Problems, 1996): neighbouring unknowns become one, until few enough are left for
// SparseCholesky. A solve begins at that coarsest level; each finer one takes over what it found, where that is not
// nearly zero, and goes on by conjugate gradients with a cycle through the coarser levels in front. So what dies away
// from its sources is solved for where it lives.
//
// For matrices that are a Laplacian with weights that are not negative plus a diagonal that is not, and for solutions
// between 0 and 1. Results are the same bits on any thread.
class Multigrid {
 public:
  static constexpr int kColumns = SparseCholesky::kColumns;  // right-hand sides solved side by side
  static constexpr Index kDirectBelow = 1u << 14;            // a solve over so many takes a few milliseconds

  //   lower        #V x #V, positive definite, only the lower triangle is read; every diagonal entry is stored
  //   directBelow  unknowns that the coarsest level may have
  // Cost: O(#V) time and memory where unknowns have few neighbours.
  explicit Multigrid(const Eigen::SparseMatrix<double>& lower, Index directBelow = kDirectBelow);
  ~Multigrid();

  struct Entry {
    Index unknown;
    double value;
  };

  // What one solve after the other works in, 130 bytes for each unknown; one for each thread.
  class Scratch {
   public:
    explicit Scratch(const Multigrid& multigrid);
    ~Scratch();

    // Of the last solve: calls visit(unknown, its kColumns solutions) for unknowns where any may be more than nearly
    // zero.
    template <class Visit>
    void forEachSolution(const Visit& visit) const {
      for (const Index row : rows()) visit((*order_)[row], solutionsOf(row));
    }

   private:
    friend class Multigrid;
    struct Level;
    std::span<const Index> rows() const;
    const float* solutionsOf(Index row) const;

    const std::vector<Index>* order_;
    std::vector<Level> levels_;
    std::vector<double> coarsest_;
  };

  // Solves for at most kColumns right-hand sides, each given by its entries, none of them named twice. Solutions below
  // `tolerance` may be taken as zero, and the last step changed none by more. Returns false where that would take more
  // than kMaxCycles, as it may over slivers: SparseCholesky solves those.
  static constexpr int kMaxCycles = 40;
  bool solve(std::span<const std::span<const Entry>> right, float tolerance, Scratch& scratch) const;

 private:
  struct Level;
  class Solve;

  std::vector<Index> order_;   // the unknown of each row: neighbours are close in memory, however the caller counts
  std::vector<Index> rowOf_;   // of each unknown
  std::vector<Level> levels_;  // finest first, without the coarsest
  std::unique_ptr<SparseCholesky> coarsest_;
  Index coarsestCount_ = 0;
};

}  // namespace limber
