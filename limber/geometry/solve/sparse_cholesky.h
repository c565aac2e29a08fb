// Cholesky factorisation for symmetric positive definite matrices over a surface, and solves with several right-hand
// sides at once.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/SparseCore>

#include "limber/geometry/solve/front_tree.h"

namespace limber {

// The multifrontal method (Duff, Reid 1983): columns with nearly the same rows make one dense block, so that nearly all
// the work is products of small dense matrices, and distant parts of the surface are factored side by side. Results are
// the same bits for any number of threads.
//
// Over surfaces it is several times as fast as Eigen's SimplicialLDLT, which follows single columns.
class SparseCholesky {
 public:
  static constexpr int kColumns = 8;

  // Orders the unknowns and lays out the factor.
  //   lower  #V x #V, only the lower triangle is read; every diagonal entry is stored
  explicit SparseCholesky(const Eigen::SparseMatrix<double>& lower);
  ~SparseCholesky();
  SparseCholesky(const SparseCholesky&) = delete;
  SparseCholesky& operator=(const SparseCholesky&) = delete;

  // `lower` has the pattern given to the constructor. A pivot that rounding makes zero or negative is replaced by 1e-14
  // of its diagonal entry; returns how many were.
  Index factorize(const Eigen::SparseMatrix<double>& lower);

  // Overwrites the first `columns` of kColumns right-hand sides with solutions.
  // x: #V rows of kColumns; the row of an unknown is rowOf(unknown).
  void solve(double* x, int columns = kColumns) const;

  Index rowOf(Index unknown) const { return tree_.positionOf[unknown]; }
  std::size_t factorEntries() const { return factorSize_; }  // doubles stored, including padding

 private:
  struct Front;
  struct SolveScratch;

  void divideWork();
  void factorizeFront(Index index, const double* values);
  void assemble(const FrontPlan& plan, const Front& front, const double* values, double* least) const;
  void addUpdate(const FrontPlan& plan, Front& front, const FrontPlan& childPlan, Front& child) const;
  void solveForward(std::size_t front, double* x, SolveScratch& scratch) const;
  void solveBackward(std::size_t front, double* x, SolveScratch& scratch) const;

  FrontTree tree_;
  std::vector<Front> fronts_;  // for each of the tree's
  struct Range {
    Index begin, end;
  };
  std::vector<Range> subtrees_;  // whole subtrees of fronts that can be factored side by side
  std::vector<Index> top_;       // the fronts above those
  std::size_t factorSize_ = 0;
  std::unique_ptr<double[]> factor_;
};

}  // namespace limber
