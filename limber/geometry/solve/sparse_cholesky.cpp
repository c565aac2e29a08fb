// The factor is kept front by front. A front with s own columns and r rows below them, both padded to S and R, is
// stored in strips of four rows: strip i holds its rows 4i to 4i+3 column after column, so every inner product of rows
// runs over memory once, and one small kernel serves factorisation and solves alike.
#include "limber/geometry/solve/sparse_cholesky.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "limber/core/parallel.h"
#include "limber/geometry/solve/front_kernels.h"

namespace limber {

namespace {

constexpr int kStrip = 4;
constexpr double kSubtreeFraction = 1.0 / 24;   // of all the work, at most, in one subtree that stays on one thread
constexpr std::size_t kParallelWork = 1 << 20;  // multiplications worth spreading over threads
constexpr Index kTile = 8;                      // strips that stay in cache together

constexpr Index padded(Index count) {
  return (count + kStrip - 1) / kStrip * kStrip;
}

constexpr std::size_t kBlockSize = kStrip * kStrip;  // of a block: element (i, j) at 4 j + i

// Lower Cholesky of one diagonal block in place. `least` is what a pivot is raised to where it is not larger.
Index factorizeBlock(double* a, const double* least) {
  Index raised = 0;
  for (int j = 0; j < kStrip; ++j) {
    double pivot = a[kStrip * j + j];
    for (int k = 0; k < j; ++k) pivot -= a[kStrip * k + j] * a[kStrip * k + j];
    if (!(pivot > least[j])) {
      pivot = least[j];
      ++raised;
    }
    const double root = std::sqrt(pivot);
    a[kStrip * j + j] = root;
    for (int i = j + 1; i < kStrip; ++i) {
      double value = a[kStrip * j + i];
      for (int k = 0; k < j; ++k) value -= a[kStrip * k + i] * a[kStrip * k + j];
      a[kStrip * j + i] = value / root;
    }
  }
  return raised;
}

// x := x * inverse(transpose(l)) for a block x below the diagonal block l.
void solveBelow(const double* l, double* x) {
  for (int j = 0; j < kStrip; ++j) {
    for (int k = 0; k < j; ++k) {
      for (int i = 0; i < kStrip; ++i) x[kStrip * j + i] -= x[kStrip * k + i] * l[kStrip * k + j];
    }
    const double inverse = 1 / l[kStrip * j + j];
    for (int i = 0; i < kStrip; ++i) x[kStrip * j + i] *= inverse;
  }
}

void forStrips(Index begin, Index end, std::size_t work, const std::function<void(std::size_t, std::size_t)>& body) {
  if (work < kParallelWork) {
    if (begin < end) body(begin, end);
    return;
  }
  parallelFor(end - begin, kTile, [&](std::size_t a, std::size_t b) { body(begin + a, begin + b); });
}

// The dense part of a front: `panel` has S columns; strips below the first S rows are its rows below.
class DenseFront {
 public:
  DenseFront(double* panel, Index ownPadded, Index rowsPadded)
      : panel_(panel), columns_(ownPadded), strips_((ownPadded + rowsPadded) / kStrip) {}

  std::size_t stripSize() const { return std::size_t{columns_} * kStrip; }
  double* strip(Index i) const { return panel_ + i * stripSize(); }

  // Left-looking over tiles of columns. `least`: S smallest pivots. Returns the number of pivots raised to those.
  Index factorize(const double* least) const {
    Index raised = 0;
    const Index columnStrips = columns_ / kStrip;
    for (Index tile = 0; tile < columnStrips; tile += kTile) {
      const Index tileEnd = std::min(tile + kTile, columnStrips);
      updateTile(tile, tileEnd);
      for (Index j = tile; j < tileEnd; ++j) raised += factorizeColumnStrip(j, tile, least + kStrip * j);
    }
    return raised;
  }

  // update (R x R, in strips, its lower blocks) -= rows below * transpose(rows below)
  void subtractSquare(double* update) const {
    const Index first = columns_ / kStrip, count = strips_ - first;
    const std::size_t stride = kBlockSize * count;
    const std::size_t work = kBlockSize * count * count * columns_ / 2;
    forStrips(0, count, work, [&](std::size_t begin, std::size_t end) {
      for (std::size_t tile = 0; tile < end; tile += kTile) {
        for (std::size_t i = std::max(begin, tile); i < end; ++i) {
          kernels_.subtractProducts(strip(first + static_cast<Index>(i)), strip(first + static_cast<Index>(tile)),
                                    stripSize(), std::min<std::size_t>(kTile, i + 1 - tile), columns_,
                                    update + i * stride + tile * kBlockSize);
        }
      }
    });
  }

 private:
  double* block(Index i, Index j) const { return strip(i) + std::size_t{j} * kStrip * kStrip; }

  // What the columns left of the tile take from its columns.
  void updateTile(Index tile, Index tileEnd) const {
    if (tile == 0) return;
    const std::size_t work = std::size_t{strips_ - tile} * (tileEnd - tile) * tile * kStrip * kStrip * kStrip;
    forStrips(tile, strips_, work, [&](std::size_t begin, std::size_t end) {
      for (Index i = static_cast<Index>(begin); i < end; ++i) {
        kernels_.subtractProducts(strip(i), strip(tile), stripSize(), std::min(tileEnd, i + 1) - tile,
                                  std::size_t{tile} * kStrip, block(i, tile));
      }
    });
  }

  Index factorizeColumnStrip(Index j, Index tile, const double* least) const {
    const Index before = (j - tile) * kStrip;
    const auto updated = [&](Index i) {
      kernels_.subtractProducts(block(i, tile), block(j, tile), 0, 1, before, block(i, j));
      return block(i, j);
    };
    const Index raised = factorizeBlock(updated(j), least);
    const std::size_t work = std::size_t{strips_ - j} * (before + kStrip) * kStrip * kStrip;
    forStrips(j + 1, strips_, work, [&](std::size_t begin, std::size_t end) {
      for (Index i = static_cast<Index>(begin); i < end; ++i) solveBelow(block(j, j), updated(i));
    });
    return raised;
  }

  const FrontKernels& kernels_ = frontKernels();
  double* panel_;
  Index columns_, strips_;
};

}  // namespace

struct SparseCholesky::Front {
  std::size_t offset = 0;  // of its panel in factor_
  Index ownPadded = 0, rowsPadded = 0;
  Index raised = 0;
  std::unique_ptr<double[]> update;  // what it adds to its parent, until that has taken it
};

struct SparseCholesky::SolveScratch {
  std::vector<double> own, below;  // rows of four
};

SparseCholesky::SparseCholesky(const Eigen::SparseMatrix<double>& lower)
    : tree_(planFronts(lower)), fronts_(tree_.fronts.size()) {
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    front.ownPadded = padded(tree_.fronts[i].ownCount());
    front.rowsPadded = padded(static_cast<Index>(tree_.fronts[i].rows.size()));
    front.offset = factorSize_;
    factorSize_ += std::size_t{front.ownPadded} * (front.ownPadded + front.rowsPadded);
  }
  divideWork();
}

SparseCholesky::~SparseCholesky() = default;

// A subtree is a range of fronts that ends with its root.
void SparseCholesky::divideWork() {
  const std::size_t count = fronts_.size();
  std::vector<double> work(count);  // of the subtree
  std::vector<Index> begin(count);
  double total = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double own = fronts_[i].ownPadded, height = own + fronts_[i].rowsPadded;
    work[i] = own * height * height;
    total += work[i];
    begin[i] = static_cast<Index>(i);
    for (const Index child : tree_.fronts[i].children) {
      work[i] += work[child];
      begin[i] = std::min(begin[i], begin[child]);
    }
  }
  for (std::size_t i = count; i > 0;) {
    --i;
    if (work[i] > kSubtreeFraction * total) {
      top_.push_back(static_cast<Index>(i));
    } else {
      subtrees_.push_back({begin[i], static_cast<Index>(i + 1)});
      i = begin[i];
    }
  }
  std::reverse(top_.begin(), top_.end());
}

Index SparseCholesky::factorize(const Eigen::SparseMatrix<double>& lower) {
  if (!factor_) factor_.reset(new double[factorSize_]);
  const double* values = lower.valuePtr();
  parallelFor(subtrees_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      for (Index i = subtrees_[s].begin; i < subtrees_[s].end; ++i) factorizeFront(i, values);
    }
  });
  for (const Index i : top_) factorizeFront(i, values);
  Index raised = 0;
  for (const Front& front : fronts_) raised += front.raised;
  return raised;
}

void SparseCholesky::factorizeFront(Index index, const double* values) {
  const FrontPlan& plan = tree_.fronts[index];
  Front& front = fronts_[index];
  const std::size_t own = front.ownPadded, below = front.rowsPadded;
  double* panel = factor_.get() + front.offset;
  std::fill(panel, panel + own * (own + below), 0.0);
  front.update.reset(below > 0 ? new double[below * below] : nullptr);
  std::fill(front.update.get(), front.update.get() + below * below, 0.0);

  std::vector<double> least(own, 0.5);  // of the padding, whose pivots are 1
  assemble(plan, front, values, least.data());
  for (const Index child : plan.children) addUpdate(plan, front, tree_.fronts[child], fronts_[child]);
  const DenseFront dense(panel, front.ownPadded, front.rowsPadded);
  front.raised = dense.factorize(least.data());
  if (below > 0) dense.subtractSquare(front.update.get());
}

// The matrix's own entries in the front's columns, and 1 on the diagonal of the padding.
void SparseCholesky::assemble(const FrontPlan& plan, const Front& front, const double* values, double* least) const {
  constexpr double kMinPivot = 1e-14;  // of the diagonal entry
  const PermutedEntries& entries = tree_.entries;
  const Index own = plan.ownCount(), stride = front.ownPadded;
  double* panel = factor_.get() + front.offset;
  const auto at = [&](Index row, Index column) -> double& {
    return panel[std::size_t{row / kStrip} * kStrip * stride + column * kStrip + row % kStrip];
  };
  for (Index column = 0; column < own; ++column) {
    for (int p = entries.first[plan.begin + column]; p < entries.first[plan.begin + column + 1]; ++p) {
      const Index index = entries.row[p];
      const double value = values[entries.position[p]];
      if (index < plan.end) {
        at(index - plan.begin, column) = value;
      } else {
        const auto row = std::lower_bound(plan.rows.begin(), plan.rows.end(), index);
        at(stride + static_cast<Index>(row - plan.rows.begin()), column) = value;
      }
    }
    least[column] = kMinPivot * at(column, column);
  }
  for (Index column = own; column < stride; ++column) at(column, column) = 1;
}

// Adds what a child left over, which is then given back.
void SparseCholesky::addUpdate(const FrontPlan& plan, Front& front, const FrontPlan& childPlan, Front& child) const {
  const Index count = static_cast<Index>(childPlan.rows.size());
  if (count == 0) return;
  const Index stride = front.ownPadded, below = front.rowsPadded, childStride = child.rowsPadded;
  // Where the child's rows lie in this front: own columns first, then the rows below.
  std::vector<Index> local(count);
  auto row = plan.rows.begin();
  Index ownCount = 0;
  for (Index i = 0; i < count; ++i) {
    if (childPlan.rows[i] < plan.end) {
      local[i] = childPlan.rows[i] - plan.begin;
      ownCount = i + 1;
    } else {
      row = std::lower_bound(row, plan.rows.end(), childPlan.rows[i]);
      local[i] = static_cast<Index>(row - plan.rows.begin());
    }
  }
  double* panel = factor_.get() + front.offset;
  for (Index i = 0; i < count; ++i) {
    const double* source = child.update.get() + std::size_t{i / kStrip} * kStrip * childStride + i % kStrip;
    const Index panelRow = i < ownCount ? local[i] : stride + local[i];
    double* toPanel = panel + std::size_t{panelRow / kStrip} * kStrip * stride + panelRow % kStrip;
    const Index ownHere = std::min(ownCount, i + 1);
    for (Index j = 0; j < ownHere; ++j) toPanel[local[j] * kStrip] += source[j * kStrip];
    if (i < ownCount) continue;
    double* toUpdate = front.update.get() + std::size_t{local[i] / kStrip} * kStrip * below + local[i] % kStrip;
    for (Index j = ownCount; j <= i; ++j) toUpdate[local[j] * kStrip] += source[j * kStrip];
  }
  child.update.reset();
}

namespace {

// Four right-hand sides over one front: rows of four, y[k] at 4 k.
constexpr int kChunk = kStrip;

// y := inverse(l) y for a diagonal block, rows of four right-hand sides.
inline void solveLower(const double* l, double* y) {
  for (int i = 0; i < kStrip; ++i) {
    for (int k = 0; k < i; ++k) {
      for (int c = 0; c < kChunk; ++c) y[i * kChunk + c] -= l[kStrip * k + i] * y[k * kChunk + c];
    }
    const double inverse = 1 / l[kStrip * i + i];
    for (int c = 0; c < kChunk; ++c) y[i * kChunk + c] *= inverse;
  }
}

inline void solveUpper(const double* l, double* y) {
  for (int i = kStrip - 1; i >= 0; --i) {
    for (int k = i + 1; k < kStrip; ++k) {
      for (int c = 0; c < kChunk; ++c) y[i * kChunk + c] -= l[kStrip * i + k] * y[k * kChunk + c];
    }
    const double inverse = 1 / l[kStrip * i + i];
    for (int c = 0; c < kChunk; ++c) y[i * kChunk + c] *= inverse;
  }
}

}  // namespace

void SparseCholesky::solve(double* x, int columns) const {
  // Both chunks of one front before the next front, while its panel is in cache.
  SolveScratch scratch;
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    for (int chunk = 0; chunk < columns; chunk += kChunk) solveForward(i, x + chunk, scratch);
  }
  for (std::size_t i = fronts_.size(); i-- > 0;) {
    for (int chunk = 0; chunk < columns; chunk += kChunk) solveBackward(i, x + chunk, scratch);
  }
}

namespace {

void loadOwn(const FrontPlan& plan, const double* x, Index ownPadded, std::vector<double>& own) {
  own.assign(std::size_t{ownPadded} * kChunk, 0.0);
  for (Index k = 0; k < plan.ownCount(); ++k) {
    std::copy_n(x + std::size_t{plan.begin + k} * SparseCholesky::kColumns, kChunk,
                own.data() + std::size_t{k} * kChunk);
  }
}

void storeOwn(const FrontPlan& plan, const std::vector<double>& own, double* x) {
  for (Index k = 0; k < plan.ownCount(); ++k) {
    std::copy_n(own.data() + std::size_t{k} * kChunk, kChunk,
                x + std::size_t{plan.begin + k} * SparseCholesky::kColumns);
  }
}

}  // namespace

void SparseCholesky::solveForward(std::size_t index, double* x, SolveScratch& scratch) const {
  const FrontKernels& kernels = frontKernels();
  std::vector<double>& own = scratch.own;
  const FrontPlan& plan = tree_.fronts[index];
  const Front& front = fronts_[index];
  loadOwn(plan, x, front.ownPadded, own);
  if (std::all_of(own.begin(), own.end(), [](double v) { return v == 0; })) return;
  const Index columns = front.ownPadded;
  const double* panel = factor_.get() + front.offset;
  const std::size_t stripSize = std::size_t{columns} * kStrip;
  for (Index i = 0; i < columns; i += kStrip) {
    const double* strip = panel + i / kStrip * stripSize;
    double* y = own.data() + std::size_t{i} * kChunk;
    kernels.subtractProducts(own.data(), strip, 0, 1, i, y);
    solveLower(strip + std::size_t{i} * kStrip, y);
  }
  storeOwn(plan, own, x);
  const std::size_t rowCount = plan.rows.size();
  std::vector<double>& below = scratch.below;
  below.assign(std::size_t{front.rowsPadded} * kChunk, 0.0);
  kernels.subtractProducts(own.data(), panel + columns / kStrip * stripSize, stripSize, front.rowsPadded / kStrip,
                           columns, below.data());
  for (std::size_t q = 0; q < rowCount; ++q) {
    double* target = x + std::size_t{plan.rows[q]} * kColumns;
    for (int c = 0; c < kChunk; ++c) target[c] += below[q * kChunk + c];
  }
}

void SparseCholesky::solveBackward(std::size_t index, double* x, SolveScratch& scratch) const {
  const FrontKernels& kernels = frontKernels();
  std::vector<double>& own = scratch.own;
  const FrontPlan& plan = tree_.fronts[index];
  const Front& front = fronts_[index];
  loadOwn(plan, x, front.ownPadded, own);
  const Index columns = front.ownPadded;
  const double* panel = factor_.get() + front.offset;
  const std::size_t stripSize = std::size_t{columns} * kStrip;
  for (std::size_t q = 0; q < plan.rows.size(); q += kStrip) {
    double below[kBlockSize] = {};
    for (std::size_t i = 0; i < kStrip && q + i < plan.rows.size(); ++i) {
      std::copy_n(x + std::size_t{plan.rows[q + i]} * kColumns, kChunk, below + i * kChunk);
    }
    kernels.subtractTransposed(panel + (columns + q) / kStrip * stripSize, below, columns, own.data());
  }
  for (Index i = columns; i > 0;) {
    i -= kStrip;
    const double* strip = panel + i / kStrip * stripSize;
    double* y = own.data() + std::size_t{i} * kChunk;
    solveUpper(strip + std::size_t{i} * kStrip, y);
    kernels.subtractTransposed(strip, y, i, own.data());
  }
  storeOwn(plan, own, x);
}

}  // namespace limber
