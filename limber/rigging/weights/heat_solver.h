// Solves for the equilibrium of heat, one joint after the other, with one factorisation.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "limber/core/grouped.h"
#include "limber/geometry/solve/laplacian.h"
#include "limber/geometry/solve/multigrid.h"
#include "limber/geometry/solve/sparse_cholesky.h"
#include "limber/rigging/weights/heat_sources.h"
#include "limber/rigging/weights/influence_table.h"

namespace limber {

// (stiffness + mass pull n) w = mass pull p for each joint (Baran, Popović 2007, equation 1, integrated over each
// vertex's area), where n counts the joints that hold a vertex and p is 1 for those. Small surfaces are solved by one
// factorisation, large ones by multigrid; what multigrid does not settle, by the factorisation.
class HeatSolver {
 public:
  static constexpr float kTolerance = 4e-4f;

  using MakeLaplacian = std::function<Laplacian()>;

  //   makeLaplacian  called at once; and once more where multigrid does not settle, for it is not kept beside it
  //   directBelow    vertices: surfaces of more are solved by multigrid
  //   tolerance      of multigrid: its last step changed no weight by more
  // Orders the unknowns; needs only where the heat can flow.
  HeatSolver(MakeLaplacian makeLaplacian, Index directBelow, float tolerance = kTolerance);

  // Vertices without a path to any source get weight 0.
  void factorize(const HeatSources& sources);

  // The strongest influences of every vertex; rows of vertices that no heat reaches are empty.
  // Cost: O(entries of the factor) for every eight joints; by multigrid O(vertices that it warms) for each joint.
  InfluenceTable strongest(Index slots);

  // All weights, #V x jointCount.
  Eigen::MatrixXd all(Index jointCount);

 private:
  static constexpr Index kBlock = SparseCholesky::kColumns;  // joints solved side by side
  static_assert(kBlock == Multigrid::kColumns);

  // Called for blocks of at most kBlock joints in any order, one at a time. With what multigrid found; or with #V rows
  // of kBlock, row r for the vertex at position r of the factorisation; columns after the last joint are 0.
  using SettledVisitor = std::function<void(std::span<const Index> joints, const Multigrid::Scratch& found)>;
  using SolvedVisitor = std::function<void(std::span<const Index> joints, const double* x)>;

  bool solveByMultigrid(const SettledVisitor& visit);  // false where some block did not settle: it is factored then
  void holdSources();
  void solveDirectly(const SolvedVisitor& visit) const;
  std::vector<std::span<const Index>> blocks() const;  // influencingJoints_, at most kBlock at a time
  void gatherPulls(const HeatSources& sources);

  MakeLaplacian makeLaplacian_;
  Laplacian laplacian_;   // the stiffness is empty beside multigrid
  Eigen::VectorXd pull_;  // by vertex: what is added to the diagonal
  std::unique_ptr<SparseCholesky> cholesky_;
  std::unique_ptr<Multigrid> multigrid_;
  Index directBelow_;
  float tolerance_;
  std::vector<Index> influencingJoints_;  // joints that hold a vertex, ascending
  Grouped<Multigrid::Entry> pulls_;       // by joint: mass * pull
};

}  // namespace limber
