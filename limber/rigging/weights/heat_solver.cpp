#include "limber/rigging/weights/heat_solver.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>

#include "limber/core/disjoint_sets.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr std::size_t kMaxScratchBuffers = 4;  // more wait for memory, not for processors
constexpr std::size_t kOfferRange = 1024;      // vertices of one parallel piece of work

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

HeatSolver::HeatSolver(MakeLaplacian makeLaplacian, Index directBelow, float tolerance)
    : makeLaplacian_(std::move(makeLaplacian)),
      laplacian_(makeLaplacian_()),
      directBelow_(directBelow),
      tolerance_(tolerance) {
  if (laplacian_.stiffness.cols() <= static_cast<Eigen::Index>(directBelow)) {
    cholesky_ = std::make_unique<SparseCholesky>(laplacian_.stiffness);
  }
}

void HeatSolver::factorize(const HeatSources& sources) {
  const int vertexCount = static_cast<int>(laplacian_.mass.size());
  const std::vector<Index> piece = matrixPieces(laplacian_.stiffness);
  std::vector<char> fed(vertexCount, 0);  // by piece
  pull_.resize(vertexCount);
  for (int v = 0; v < vertexCount; ++v) {
    pull_[v] = laplacian_.mass[v] * sources.pull[v] * static_cast<double>(sources.jointsOf(v).size());
    if (pull_[v] > 0) fed[piece[v]] = 1;
  }
  // A piece that no heat enters would be singular. Any number there keeps it regular and its weights 0.
  for (int v = 0; v < vertexCount; ++v) {
    if (!fed[piece[v]]) pull_[v] = 1;
  }
  holdSources();
  if (cholesky_) {
    cholesky_->factorize(laplacian_.stiffness);
  } else {
    multigrid_ = std::make_unique<Multigrid>(laplacian_.stiffness, std::min(directBelow_, Multigrid::kDirectBelow));
    Eigen::SparseMatrix<double>().swap(laplacian_.stiffness);  // assigned to, it would keep its memory
  }
  gatherPulls(sources);
}

void HeatSolver::holdSources() {
  for (int v = 0; v < pull_.size(); ++v) laplacian_.stiffness.coeffRef(v, v) += pull_[v];
}

void HeatSolver::gatherPulls(const HeatSources& sources) {
  const Index jointCount =
      sources.joints.empty() ? 0 : *std::max_element(sources.joints.begin(), sources.joints.end()) + 1;
  pulls_ = Grouped<Multigrid::Entry>(jointCount, [&](const auto& visit) {
    for (Index v = 0; v < sources.pull.size(); ++v) {
      for (const Index joint : sources.jointsOf(v)) visit(joint, {v, laplacian_.mass[v] * sources.pull[v]});
    }
  });
  for (Index joint = 0; joint < jointCount; ++joint) {
    if (!pulls_.of(joint).empty()) influencingJoints_.push_back(joint);
  }
}

InfluenceTable HeatSolver::strongest(Index slots) {
  const Index vertexCount = static_cast<Index>(laplacian_.mass.size());
  if (multigrid_) {
    InfluenceTable result(vertexCount, slots);
    const bool settled = solveByMultigrid([&](std::span<const Index> joints, const Multigrid::Scratch& found) {
      found.forEachSolution([&](Index v, const float* weights) {
        for (std::size_t k = 0; k < joints.size(); ++k) result.offer(v, joints[k], weights[k]);
      });
    });
    if (settled) return result;
  }
  InfluenceTable result(vertexCount, slots), bySlot(vertexCount, slots);
  solveDirectly([&](std::span<const Index> joints, const double* x) {
    for (std::size_t row = 0; row < vertexCount; ++row) {
      for (std::size_t k = 0; k < joints.size(); ++k) {
        bySlot.offer(row, joints[k], static_cast<float>(x[row * kBlock + k]));
      }
    }
  });
  parallelFor(vertexCount, kOfferRange, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const Index row = cholesky_->rowOf(static_cast<Index>(v));
      for (Index k = 0; k < slots; ++k) result.offer(v, bySlot.jointsOf(row)[k], bySlot.weightsOf(row)[k]);
    }
  });
  return result;
}

Eigen::MatrixXd HeatSolver::all(Index jointCount) {
  const Index vertexCount = static_cast<Index>(laplacian_.mass.size());
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(vertexCount, jointCount);
  if (multigrid_) {
    const bool settled = solveByMultigrid([&](std::span<const Index> joints, const Multigrid::Scratch& found) {
      found.forEachSolution([&](Index v, const float* weights) {
        for (std::size_t k = 0; k < joints.size(); ++k) result(v, joints[k]) = weights[k];
      });
    });
    if (settled) return result;
  }
  solveDirectly([&](std::span<const Index> joints, const double* x) {
    for (Index v = 0; v < vertexCount; ++v) {
      const std::size_t row = cholesky_->rowOf(v);
      for (std::size_t k = 0; k < joints.size(); ++k) result(v, joints[k]) = x[row * kBlock + k];
    }
  });
  return result;
}

std::vector<std::span<const Index>> HeatSolver::blocks() const {
  std::vector<std::span<const Index>> result;
  for (std::size_t first = 0; first < influencingJoints_.size(); first += kBlock) {
    const std::size_t count = std::min<std::size_t>(kBlock, influencingJoints_.size() - first);
    result.push_back(std::span<const Index>(influencingJoints_).subspan(first, count));
  }
  return result;
}

bool HeatSolver::solveByMultigrid(const SettledVisitor& visit) {
  const std::vector<std::span<const Index>> all = blocks();
  std::mutex visiting;
  std::atomic<bool> settled = true;
  std::atomic<std::size_t> next = 0;
  parallelFor(std::min<std::size_t>(threadCount(), kMaxScratchBuffers), 1, [&](std::size_t, std::size_t) {
    Multigrid::Scratch scratch(*multigrid_);
    std::vector<std::span<const Multigrid::Entry>> right;
    for (std::size_t block = next++; block < all.size() && settled; block = next++) {
      right.clear();
      for (const Index joint : all[block]) right.push_back(pulls_.of(joint));
      if (!multigrid_->solve(right, tolerance_, scratch)) {
        settled = false;
        break;
      }
      const std::lock_guard lock(visiting);
      visit(all[block], scratch);
    }
  });
  multigrid_.reset();
  if (settled) return true;
  laplacian_ = makeLaplacian_();
  holdSources();
  cholesky_ = std::make_unique<SparseCholesky>(laplacian_.stiffness);
  cholesky_->factorize(laplacian_.stiffness);
  return false;
}

void HeatSolver::solveDirectly(const SolvedVisitor& visit) const {
  const std::vector<std::span<const Index>> all = blocks();
  std::mutex visiting;
  parallelFor(all.size(), 1, [&](std::size_t block, std::size_t) {
    const std::span<const Index> joints = all[block];
    std::vector<double> x(static_cast<std::size_t>(laplacian_.mass.size()) * kBlock, 0.0);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      for (const Multigrid::Entry& pull : pulls_.of(joints[k])) {
        x[cholesky_->rowOf(pull.unknown) * std::size_t{kBlock} + k] = pull.value;
      }
    }
    cholesky_->solve(x.data(), static_cast<int>(joints.size()));
    const std::lock_guard lock(visiting);
    visit(joints, x.data());
  });
}

}  // namespace limber
