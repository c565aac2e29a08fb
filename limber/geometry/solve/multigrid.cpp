#include "limber/geometry/solve/multigrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "limber/core/float4.h"
#include "limber/geometry/solve/aggregation.h"

namespace limber {

// Numbers are single while cycles run, which halves what moves through memory.
namespace multigrid {

// Of the finest level (Vanek and others 1996, section 3.2); halved on each coarser one.
constexpr double kStrongLinks = 0.08;

// One number for each right-hand side.
struct Columns {
  Float4 low, high;

  void add(float weight, const Columns& other) {
    low += weight * other.low;
    high += weight * other.high;
  }
  // Adds weight * (a - b).
  void addDifference(float weight, const Columns& a, const Columns& b) {
    low += weight * (a.low - b.low);
    high += weight * (a.high - b.high);
  }
  float operator[](int column) const { return column < 4 ? low[column] : high[column - 4]; }
  void set(int column, float value) {
    Float4& half = column < 4 ? low : high;
    half[column % 4] = value;
  }
};
static_assert(sizeof(Columns) == Multigrid::kColumns * sizeof(float));

Columns operator*(const Columns& a, const Columns& b) {
  return {a.low * b.low, a.high * b.high};
}

using ColumnSums = std::array<double, Multigrid::kColumns>;

// Adds up in double precision, a few hundred rows at a time.
class ColumnSum {
 public:
  void add(const Columns& product) {
    part_.add(1, product);
    if (++count_ % 256 == 0) flush();
  }
  const ColumnSums& total() {
    flush();
    return total_;
  }

 private:
  void flush() {
    for (int k = 0; k < Multigrid::kColumns; ++k) total_[k] += part_[k];
    part_ = Columns();
  }

  Columns part_ = Columns();
  ColumnSums total_ = {};
  std::size_t count_ = 0;
};

Columns quotients(const ColumnSums& a, const ColumnSums& b) {
  Columns result = {};
  for (int k = 0; k < Multigrid::kColumns; ++k) result.set(k, b[k] > 0 ? static_cast<float>(a[k] / b[k]) : 0);
  return result;
}

float largestMagnitude(const Columns& columns) {
  float largest = 0;
  for (int k = 0; k < Multigrid::kColumns; ++k) largest = std::max(largest, std::abs(columns[k]));
  return largest;
}

// Rows of weights.
struct WeightRows {
  std::vector<std::size_t> first;  // #rows + 1
  std::vector<Index> column;
  std::vector<float> weight;
};

// A matrix as what flows along links and what flows out of each unknown: a x = out x + sum of weight (x - x there), so
// that rounding is that of differences.
struct FlowRows {
  WeightRows links;
  std::vector<float> out;
  std::vector<float> inverseDiagonal;

  explicit FlowRows(const SparseRows& matrix) {
    links.first.reserve(matrix.first.size());
    links.column.reserve(matrix.column.size() - matrix.rowCount());
    links.weight.reserve(matrix.column.size() - matrix.rowCount());
    links.first.push_back(0);
    for (Index row = 0; row < matrix.rowCount(); ++row) {
      double sum = 0, diagonal = 0;
      for (std::size_t i = matrix.first[row]; i < matrix.first[row + 1]; ++i) {
        sum += matrix.value[i];
        if (matrix.column[i] == row) {
          diagonal = matrix.value[i];
        } else {
          links.column.push_back(matrix.column[i]);
          links.weight.push_back(static_cast<float>(-matrix.value[i]));
        }
      }
      links.first.push_back(links.column.size());
      out.push_back(static_cast<float>(std::max(0.0, sum)));
      inverseDiagonal.push_back(static_cast<float>(1 / diagonal));
    }
  }

  Index rowCount() const { return static_cast<Index>(out.size()); }

  Columns image(Index row, const Columns* x) const {
    Columns sum = {};
    sum.add(out[row], x[row]);
    for (std::size_t i = links.first[row]; i < links.first[row + 1]; ++i) {
      sum.addDifference(links.weight[i], x[row], x[links.column[i]]);
    }
    return sum;
  }

  // A step of Gauss and Seidel.
  void relax(Index row, const Columns* right, Columns* x) const {
    Columns sum = right[row];
    for (std::size_t i = links.first[row]; i < links.first[row + 1]; ++i) sum.add(links.weight[i], x[links.column[i]]);
    divide(row, sum, x);
  }

  // The same in ascending order from x = 0: rows behind this one add nothing, and are not read.
  void relaxFromZero(Index row, const Columns* right, Columns* x) const {
    Columns sum = right[row];
    for (std::size_t i = links.first[row]; i < links.first[row + 1] && links.column[i] < row; ++i) {
      sum.add(links.weight[i], x[links.column[i]]);
    }
    divide(row, sum, x);
  }

  // What that leaves of the right-hand side: what the rows behind this one added after it.
  Columns leftFromZero(Index row, const Columns* x) const {
    Columns sum = {};
    for (std::size_t i = links.first[row + 1]; i > links.first[row] && links.column[i - 1] > row; --i) {
      sum.add(links.weight[i - 1], x[links.column[i - 1]]);
    }
    return sum;
  }

 private:
  void divide(Index row, const Columns& sum, Columns* x) const {
    x[row] = {sum.low * inverseDiagonal[row], sum.high * inverseDiagonal[row]};
  }
};

// Rows in chunks, so that what one pass leaves in the cache is what the next begins with: passes over a level run one
// behind the other, a chunk at a time.
constexpr Index kChunkRows = 1024;

// For each chunk, the first and the last chunk that its rows are linked with.
struct ChunkLinks {
  explicit ChunkLinks(const WeightRows& links) {
    const Index rows = static_cast<Index>(links.first.size() - 1);
    for (Index begin = 0; begin < rows; begin += kChunkRows) {
      const Index end = std::min(rows, begin + kChunkRows), chunk = begin / kChunkRows;
      first.push_back(chunk);
      last.push_back(chunk);
      for (std::size_t i = links.first[begin]; i < links.first[end]; ++i) {
        first.back() = std::min(first.back(), links.column[i] / kChunkRows);
        last.back() = std::max(last.back(), links.column[i] / kChunkRows);
      }
    }
  }

  Index count() const { return static_cast<Index>(first.size()); }

  std::vector<Index> first, last;
};

WeightRows single(const SparseRows& rows) {
  return {rows.first, rows.column, std::vector<float>(rows.value.begin(), rows.value.end())};
}

}  // namespace multigrid

using namespace multigrid;

struct Multigrid::Level {
  Level(const SparseRows& rows, const SparseRows& fromCoarser)
      : matrix(rows), prolong(single(fromCoarser)), chunks(matrix.links) {}

  FlowRows matrix;
  WeightRows prolong;  // from the next coarser level
  ChunkLinks chunks;
};

struct Multigrid::Scratch::Level {
  std::vector<Columns> right;         // kept for what is active, or a source
  std::vector<Columns> x, direction;  // 0 wherever nothing is active
  std::vector<Columns> found;         // kept for what is active
  std::vector<char> isActive;
  std::vector<Index> active;   // ascending: where x is looked for
  std::vector<Index> firstOf;  // in `active`, of each chunk of rows; and the end
  std::vector<Index> sources;  // where the right-hand sides of the solve are not 0
};

Multigrid::Multigrid(const Eigen::SparseMatrix<double>& lower, Index directBelow) {
  SparseRows matrix = rowsOf(lower);
  order_ = breadthFirst(matrix);
  rowOf_.resize(order_.size());
  for (Index row = 0; row < order_.size(); ++row) rowOf_[order_[row]] = row;
  matrix = reordered(matrix, order_);
  for (double strongLinks = kStrongLinks; matrix.rowCount() > directBelow; strongLinks /= 2) {
    std::optional<CoarserMatrix> coarser = coarserMatrix(matrix, strongLinks);
    if (!coarser) break;
    levels_.emplace_back(matrix, coarser->prolong);
    matrix = std::move(coarser->matrix);
  }
  coarsestCount_ = matrix.rowCount();
  const Eigen::SparseMatrix<double> coarsest = lowerTriangle(matrix);
  coarsest_ = std::make_unique<SparseCholesky>(coarsest);
  coarsest_->factorize(coarsest);
}

Multigrid::~Multigrid() = default;

Multigrid::Scratch::Scratch(const Multigrid& multigrid)
    : order_(&multigrid.order_), coarsest_(multigrid.coarsestCount_ * std::size_t{kColumns}, 0) {
  for (std::size_t l = 0; l <= multigrid.levels_.size(); ++l) {
    const bool isCoarsest = l == multigrid.levels_.size();
    const std::size_t count = isCoarsest ? multigrid.coarsestCount_ : multigrid.levels_[l].matrix.rowCount();
    Level level;
    level.right.resize(count);
    level.x.resize(count);
    level.isActive.resize(count);
    if (!isCoarsest) {
      level.direction.resize(count);
      level.found.resize(count);
    }
    levels_.push_back(std::move(level));
  }
}

Multigrid::Scratch::~Scratch() = default;

std::span<const Index> Multigrid::Scratch::rows() const {
  return levels_[0].active;
}

const float* Multigrid::Scratch::solutionsOf(Index row) const {
  return reinterpret_cast<const float*>(&levels_[0].x[row]);
}

// Solves one block of right-hand sides.
class Multigrid::Solve {
 public:
  Solve(const Multigrid& multigrid, float tolerance, Scratch& scratch)
      : multigrid_(multigrid), levels_(multigrid.levels_), tolerance_(tolerance), scratch_(scratch) {}

  bool run(std::span<const std::span<const Entry>> right) {
    clear();
    scatter(right);
    Scratch::Level& coarsest = scratch_.levels_.back();
    for (Index v = 0; v < multigrid_.coarsestCount_; ++v) {
      coarsest.active.push_back(v);
      if (!coarsest.isActive[v]) coarsest.right[v] = Columns();
    }
    solveCoarsest();
    for (std::size_t l = levels_.size(); l-- > 0;) {
      activate(l);
      addProlonged(l, scratch_.levels_[l].active);
      if (!settle(l)) return false;
    }
    return true;
  }

 private:
  void clear() {
    for (Scratch::Level& level : scratch_.levels_) {
      for (const Index v : level.active) {
        level.x[v] = Columns();
        level.isActive[v] = 0;
      }
      for (const Index v : level.sources) level.isActive[v] = 0;
      level.active.clear();
      level.sources.clear();
    }
  }

  // The right-hand sides on every level; sources are active.
  void scatter(std::span<const std::span<const Entry>> right) {
    for (std::size_t k = 0; k < right.size(); ++k) {
      for (const Entry& entry : right[k]) {
        source(scratch_.levels_[0], multigrid_.rowOf_[entry.unknown])
            .set(static_cast<int>(k), static_cast<float>(entry.value));
      }
    }
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      const WeightRows& prolong = levels_[l].prolong;
      for (const Index v : scratch_.levels_[l].sources) {
        for (std::size_t i = prolong.first[v]; i < prolong.first[v + 1]; ++i) {
          source(scratch_.levels_[l + 1], prolong.column[i]).add(prolong.weight[i], scratch_.levels_[l].right[v]);
        }
      }
    }
  }

  static Columns& source(Scratch::Level& level, Index v) {
    if (!level.isActive[v]) {
      level.isActive[v] = 1;
      level.sources.push_back(v);
      level.right[v] = Columns();
    }
    return level.right[v];
  }

  void solveCoarsest() {
    Scratch::Level& level = scratch_.levels_.back();
    const SparseCholesky& cholesky = *multigrid_.coarsest_;
    const auto rowOf = [&](Index v) { return scratch_.coarsest_.data() + cholesky.rowOf(v) * std::size_t{kColumns}; };
    for (Index v = 0; v < multigrid_.coarsestCount_; ++v) {
      for (int k = 0; k < kColumns; ++k) rowOf(v)[k] = level.right[v][k];
    }
    cholesky.solve(scratch_.coarsest_.data());
    for (Index v = 0; v < multigrid_.coarsestCount_; ++v) {
      for (int k = 0; k < kColumns; ++k) level.x[v].set(k, static_cast<float>(rowOf(v)[k]));
    }
  }

  // Where a coarser unknown that it takes from is not nearly zero, and where the sources are.
  void activate(std::size_t l) {
    Scratch::Level& level = scratch_.levels_[l];
    const Scratch::Level& coarse = scratch_.levels_[l + 1];
    isNear_.assign(coarse.x.size(), 0);
    for (const Index c : coarse.active) isNear_[c] = largestMagnitude(coarse.x[c]) > tolerance_;
    const WeightRows& prolong = levels_[l].prolong;
    for (Index v = 0; v < level.isActive.size(); ++v) {
      bool active = level.isActive[v];
      if (!active) level.right[v] = Columns();
      for (std::size_t i = prolong.first[v]; i < prolong.first[v + 1] && !active; ++i)
        active = isNear_[prolong.column[i]];
      if (!active) continue;
      level.isActive[v] = 1;
      level.active.push_back(v);
    }
    level.firstOf.clear();
    std::size_t next = 0;
    for (Index chunk = 0; chunk < levels_[l].chunks.count(); ++chunk) {
      level.firstOf.push_back(static_cast<Index>(next));
      while (next < level.active.size() && level.active[next] / kChunkRows == chunk) ++next;
    }
    level.firstOf.push_back(static_cast<Index>(next));
  }

  // The active rows of a chunk, ascending.
  static std::span<const Index> activeOf(const Scratch::Level& level, Index chunk) {
    return std::span(level.active).subspan(level.firstOf[chunk], level.firstOf[chunk + 1] - level.firstOf[chunk]);
  }

  void addProlonged(std::size_t l, std::span<const Index> rows) {
    Scratch::Level& level = scratch_.levels_[l];
    const Columns* coarse = scratch_.levels_[l + 1].x.data();
    const WeightRows& prolong = levels_[l].prolong;
    for (const Index v : rows) {
      for (std::size_t i = prolong.first[v]; i < prolong.first[v + 1]; ++i) {
        level.x[v].add(prolong.weight[i], coarse[prolong.column[i]]);
      }
    }
  }

  // Conjugate gradients, from what x holds to what it is to be. Where the finer level leaves out what is nearly zero,
  // its part of the coarser functions is not what the coarser matrix was made for, so the cycles alone need not
  // converge; but they are symmetric and positive.
  bool settle(std::size_t l) {
    Scratch::Level& level = scratch_.levels_[l];
    const FlowRows& matrix = levels_[l].matrix;
    for (const Index v : level.active) {
      level.found[v] = level.x[v];
      const Columns image = matrix.image(v, level.x.data());
      level.right[v].add(-1, image);
    }
    bool settled = false;
    ColumnSums before = {};
    smoothDown(l, [](Index) {});
    for (int cycles = 0; cycles < kMaxCycles && !settled; ++cycles) {
      cycle(l + 1);
      const ColumnSums now = smoothUp(l);
      const Columns step = quotients(now, redirect(l, quotients(now, before)));
      before = now;
      float change = 0;
      smoothDown(l, [&](Index v) {
        const Columns move = step * level.direction[v];
        level.found[v].add(1, move);
        level.right[v].add(-1, step * level.x[v]);
        change = std::max(change, largestMagnitude(move));
      });
      settled = change <= tolerance_;
    }
    for (const Index v : level.active) {
      level.x[v] = level.found[v];
      level.direction[v] = Columns();
    }
    return settled;
  }

  // The next direction is the x of a cycle and so much of the last one. Leaves its image in x; returns its energy.
  ColumnSums redirect(std::size_t l, const Columns& keep) {
    Scratch::Level& level = scratch_.levels_[l];
    const ChunkLinks& chunks = levels_[l].chunks;
    ColumnSum energy;
    Index turned = 0;  // chunks
    for (Index chunk = 0; chunk < chunks.count(); ++chunk) {
      for (; turned <= chunks.last[chunk]; ++turned) {
        for (const Index v : activeOf(level, turned)) {
          level.direction[v] = keep * level.direction[v];
          level.direction[v].add(1, level.x[v]);
        }
      }
      for (const Index v : activeOf(level, chunk)) {
        level.x[v] = levels_[l].matrix.image(v, level.direction.data());
        energy.add(level.x[v] * level.direction[v]);
      }
    }
    return energy.total();
  }

  // Leaves in x about what the level's matrix takes to `right`: forward, coarser, backward.
  void cycle(std::size_t l) {
    if (l == levels_.size()) return solveCoarsest();
    smoothDown(l, [](Index) {});
    cycle(l + 1);
    smoothUp(l);
  }

  // Forward from x = 0, each row after `prepare(row)`; what is left goes to the right-hand side of the coarser level.
  template <class Prepare>
  void smoothDown(std::size_t l, const Prepare& prepare) {
    Scratch::Level& level = scratch_.levels_[l];
    Scratch::Level& coarse = scratch_.levels_[l + 1];
    const FlowRows& matrix = levels_[l].matrix;
    const WeightRows& prolong = levels_[l].prolong;
    const ChunkLinks& chunks = levels_[l].chunks;
    for (const Index c : coarse.active) coarse.right[c] = Columns();
    Index handedOn = 0;  // chunks
    for (Index chunk = 0; chunk < chunks.count(); ++chunk) {
      for (const Index v : activeOf(level, chunk)) {
        prepare(v);
        matrix.relaxFromZero(v, level.right.data(), level.x.data());
      }
      for (; handedOn < chunks.count() && chunks.last[handedOn] <= chunk; ++handedOn) {
        for (const Index v : activeOf(level, handedOn)) {
          const Columns left = matrix.leftFromZero(v, level.x.data());
          for (std::size_t i = prolong.first[v]; i < prolong.first[v + 1]; ++i) {
            coarse.right[prolong.column[i]].add(prolong.weight[i], left);
          }
        }
      }
    }
  }

  // Backward, from what was forward and what the coarser level found. Returns the products of right and x.
  ColumnSums smoothUp(std::size_t l) {
    Scratch::Level& level = scratch_.levels_[l];
    const FlowRows& matrix = levels_[l].matrix;
    const ChunkLinks& chunks = levels_[l].chunks;
    ColumnSum products;
    Index prolonged = chunks.count();  // this chunk and those behind
    for (Index chunk = chunks.count(); chunk-- > 0;) {
      while (prolonged > chunks.first[chunk]) addProlonged(l, activeOf(level, --prolonged));
      const std::span<const Index> rows = activeOf(level, chunk);
      for (auto row = rows.rbegin(); row != rows.rend(); ++row) {
        matrix.relax(*row, level.right.data(), level.x.data());
        products.add(level.right[*row] * level.x[*row]);
      }
    }
    return products.total();
  }

  const Multigrid& multigrid_;
  const std::vector<Multigrid::Level>& levels_;
  const float tolerance_;
  Scratch& scratch_;
  std::vector<char> isNear_;  // by coarser unknown
};

bool Multigrid::solve(std::span<const std::span<const Entry>> right, float tolerance, Scratch& scratch) const {
  return Solve(*this, tolerance, scratch).run(right);
}

}  // namespace limber
