#include "limber/skinning/heat_solver.h"

#include <algorithm>
#include <mutex>
#include <numeric>
#include <utility>

#include "limber/core/disjoint_sets.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

// Pieces of the graph of the matrix, numbered by the lowest vertex they hold.
std::vector<Index> matrixPieces(const Eigen::SparseMatrix<double>& matrix) {
  DisjointSets sets(matrix.cols());
  for (int column = 0; column < matrix.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(matrix, column); it; ++it) {
      sets.unite(static_cast<Index>(column), static_cast<Index>(it.row()));
    }
  }
  std::vector<Index> pieces(matrix.cols());
  for (Index v = 0; v < pieces.size(); ++v) pieces[v] = sets.find(v);
  return pieces;
}

}  // namespace

HeatSolver::HeatSolver(Laplacian laplacian) : laplacian_(std::move(laplacian)), cholesky_(laplacian_.stiffness) {}

void HeatSolver::factorize(const HeatSources& sources) {
  const int vertexCount = static_cast<int>(laplacian_.stiffness.cols());
  const std::vector<Index> piece = matrixPieces(laplacian_.stiffness);
  std::vector<char> fed(vertexCount, 0);  // by piece
  Eigen::VectorXd held(vertexCount);
  for (int v = 0; v < vertexCount; ++v) {
    held[v] = laplacian_.mass[v] * sources.pull[v] * static_cast<double>(sources.jointsOf(v).size());
    if (held[v] > 0) fed[piece[v]] = 1;
  }
  for (int v = 0; v < vertexCount; ++v) {
    // A piece that no heat enters would be singular. Any number there keeps it regular and its weights 0.
    laplacian_.stiffness.coeffRef(v, v) += fed[piece[v]] ? held[v] : 1.0;
  }
  cholesky_.factorize(laplacian_.stiffness);
  gatherPulls(sources);
}

void HeatSolver::gatherPulls(const HeatSources& sources) {
  const Index jointCount =
      sources.joints.empty() ? 0 : *std::max_element(sources.joints.begin(), sources.joints.end()) + 1;
  firstPull_.assign(jointCount + std::size_t{1}, 0);
  for (const Index joint : sources.joints) ++firstPull_[joint + 1];
  for (Index joint = 0; joint < jointCount; ++joint) {
    if (firstPull_[joint + 1] > 0) heldJoints_.push_back(joint);
  }
  std::partial_sum(firstPull_.begin(), firstPull_.end(), firstPull_.begin());
  pulls_.resize(sources.joints.size());
  std::vector<std::size_t> end(firstPull_.begin(), firstPull_.end() - 1);
  for (Index v = 0; v < sources.pull.size(); ++v) {
    for (const Index joint : sources.jointsOf(v)) {
      pulls_[end[joint]++] = {place(v), laplacian_.mass[v] * sources.pull[v]};
    }
  }
}

void HeatSolver::solve(const BlockVisitor& visit) const {
  const std::size_t blocks = (heldJoints_.size() + kBlock - 1) / kBlock;
  std::mutex visiting;
  parallelFor(blocks, 1, [&](std::size_t begin, std::size_t end) {
    std::vector<double> x(static_cast<std::size_t>(laplacian_.stiffness.cols()) * kBlock);
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t first = block * kBlock;
      const std::span<const Index> joints(heldJoints_.data() + first,
                                          std::min<std::size_t>(kBlock, heldJoints_.size() - first));
      solveBlock(joints, x);
      const std::lock_guard lock(visiting);
      visit(joints, x.data());
    }
  });
}

void HeatSolver::solveBlock(std::span<const Index> joints, std::vector<double>& x) const {
  std::fill(x.begin(), x.end(), 0.0);
  for (std::size_t k = 0; k < joints.size(); ++k) {
    for (std::size_t i = firstPull_[joints[k]]; i < firstPull_[joints[k] + 1]; ++i) {
      x[pulls_[i].place * std::size_t{kBlock} + k] = pulls_[i].value;
    }
  }
  cholesky_.solve(x.data(), static_cast<int>(joints.size()));
}

}  // namespace limber
