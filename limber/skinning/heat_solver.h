// Solves for the equilibrium of heat, one joint after the other, with one factorisation.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "limber/mesh/laplacian.h"
#include "limber/mesh/sparse_cholesky.h"
#include "limber/skinning/heat_sources.h"

namespace limber {

// (stiffness + mass pull n) w = mass pull p for each joint (Baran, Popović 2007, equation 1, integrated over each
// vertex's area), where n counts the joints that hold a vertex and p is 1 for those.
class HeatSolver {
 public:
  static constexpr int kBlock = SparseCholesky::kColumns;  // joints solved side by side

  // Orders the unknowns; needs only where the heat can flow.
  explicit HeatSolver(Laplacian laplacian);

  // Vertices without a way to any source get weight 0.
  void factorize(const HeatSources& sources);

  // Calls visit(joints, weights) for blocks of at most kBlock of the joints that hold a vertex, in any order and on any
  // thread, one at a time. weights: #V rows of kBlock, row r for the vertex with place(v) == r; columns after the last
  // joint are 0. Cost: O(entries of the factor) for each block.
  using BlockVisitor = std::function<void(std::span<const Index> joints, const double* weights)>;
  void solve(const BlockVisitor& visit) const;

  Index place(Index vertex) const { return cholesky_.place(vertex); }

 private:
  struct Pull {
    Index place;
    double value;  // mass * pull
  };

  void gatherPulls(const HeatSources& sources);
  void solveBlock(std::span<const Index> joints, std::vector<double>& x) const;

  Laplacian laplacian_;
  SparseCholesky cholesky_;
  std::vector<Index> heldJoints_;       // joints that hold a vertex, ascending
  std::vector<std::size_t> firstPull_;  // by joint
  std::vector<Pull> pulls_;
};

}  // namespace limber
