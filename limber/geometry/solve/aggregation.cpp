#include "limber/geometry/solve/aggregation.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "limber/core/parallel.h"

namespace limber {

namespace {

constexpr double kSmoothing = 4.0 / 3.0;  // Vanek and others 1996, section 3.2
constexpr double kMinShrinking = 0.8;     // a coarser level that keeps a larger fraction of the unknowns gains nothing
constexpr std::size_t kRowRange = 4096;   // rows of one parallel piece of work

// Rows computed side by side and put together in their order. `fill(row, columns, values)` appends one row.
template <class MakeFill>
SparseRows filledRows(Index rowCount, Index columnCount, const MakeFill& makeFill) {
  const std::size_t ranges = (rowCount + kRowRange - 1) / kRowRange;
  struct Part {
    std::vector<std::size_t> end;
    std::vector<Index> column;
    std::vector<double> value;
  };
  std::vector<Part> parts(ranges);
  parallelFor(ranges, 16, [&](std::size_t begin, std::size_t end) {
    auto fill = makeFill();
    for (std::size_t r = begin; r < end; ++r) {
      Part& part = parts[r];
      for (std::size_t row = r * kRowRange; row < std::min<std::size_t>(rowCount, (r + 1) * kRowRange); ++row) {
        fill(static_cast<Index>(row), part.column, part.value);
        part.end.push_back(part.column.size());
      }
    }
  });
  SparseRows result;
  result.columnCount = columnCount;
  result.first.reserve(rowCount + std::size_t{1});
  std::size_t total = 0;
  for (const Part& part : parts) total += part.column.size();
  result.column.reserve(total);
  result.value.reserve(total);
  for (Part& part : parts) {
    const std::size_t before = result.column.size();
    for (const std::size_t end : part.end) result.first.push_back(before + end);
    result.column.insert(result.column.end(), part.column.begin(), part.column.end());
    result.value.insert(result.value.end(), part.value.begin(), part.value.end());
    part = {};
  }
  return result;
}

// Adds up one row of a product (Gustavson: Two Fast Algorithms for Sparse Matrices, 1978).
class RowSum {
 public:
  explicit RowSum(Index columnCount) : sum_(columnCount, 0), seen_(columnCount, 0) {}

  void add(Index column, double value) {
    if (!seen_[column]) {
      seen_[column] = 1;
      columns_.push_back(column);
    }
    sum_[column] += value;
  }

  void moveTo(std::vector<Index>& columns, std::vector<double>& values) {
    std::sort(columns_.begin(), columns_.end());
    for (const Index column : columns_) {
      columns.push_back(column);
      values.push_back(sum_[column]);
      sum_[column] = 0;
      seen_[column] = 0;
    }
    columns_.clear();
  }

 private:
  std::vector<double> sum_;
  std::vector<char> seen_;
  std::vector<Index> columns_;
};

SparseRows product(const SparseRows& a, const SparseRows& b) {
  return filledRows(a.rowCount(), b.columnCount, [&] {
    return
        [&, sum = RowSum(b.columnCount)](Index row, std::vector<Index>& columns, std::vector<double>& values) mutable {
          for (std::size_t i = a.first[row]; i < a.first[row + 1]; ++i) {
            const Index through = a.column[i];
            for (std::size_t k = b.first[through]; k < b.first[through + 1]; ++k)
              sum.add(b.column[k], a.value[i] * b.value[k]);
          }
          sum.moveTo(columns, values);
        };
  });
}

SparseRows transposed(const SparseRows& matrix) {
  SparseRows result;
  result.columnCount = matrix.rowCount();
  result.first.assign(matrix.columnCount + std::size_t{1}, 0);
  for (const Index column : matrix.column) ++result.first[column + std::size_t{1}];
  for (std::size_t row = 1; row < result.first.size(); ++row) result.first[row] += result.first[row - 1];
  result.column.resize(matrix.column.size());
  result.value.resize(matrix.column.size());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  for (Index row = 0; row < matrix.rowCount(); ++row) {
    for (std::size_t i = matrix.first[row]; i < matrix.first[row + 1]; ++i) {
      const std::size_t at = next[matrix.column[i]]++;
      result.column[at] = row;
      result.value[at] = matrix.value[i];
    }
  }
  return result;
}

// The Laplacian in the matrix, without what its rows sum to: constants stay what they are under it. Weak entries off
// the diagonal are gone (there, equation 3.9). The diagonal is stored separately.
struct Links {
  SparseRows strong;  // off the diagonal
  std::vector<double> diagonal;
};

Links linksOf(const SparseRows& matrix, double threshold) {
  const std::vector<double> diagonal = [&] {
    std::vector<double> sums(matrix.rowCount(), 0);
    for (Index row = 0; row < matrix.rowCount(); ++row) {
      for (std::size_t i = matrix.first[row]; i < matrix.first[row + 1]; ++i) {
        if (matrix.column[i] != row) sums[row] -= matrix.value[i];
      }
    }
    return sums;
  }();
  Links links;
  links.diagonal.assign(matrix.rowCount(), 0);
  links.strong = filledRows(matrix.rowCount(), matrix.columnCount, [&] {
    return [&](Index row, std::vector<Index>& columns, std::vector<double>& values) {
      for (std::size_t i = matrix.first[row]; i < matrix.first[row + 1]; ++i) {
        const Index column = matrix.column[i];
        const double value = matrix.value[i];
        if (column == row || value * value < threshold * threshold * diagonal[row] * diagonal[column]) continue;
        columns.push_back(column);
        values.push_back(value);
        links.diagonal[row] -= value;
      }
    };
  });
  return links;
}

// Aggregates of strongly linked unknowns (there, algorithm 3.1): whole free neighbourhoods, then what touches them,
// then the rest. Returns their count.
Index aggregate(const SparseRows& strong, std::vector<Index>& of) {
  const Index count = strong.rowCount();
  of.assign(count, kNoIndex);
  Index aggregates = 0;
  const auto neighbours = [&](Index row) {
    return std::span<const Index>(strong.column.data() + strong.first[row], strong.first[row + 1] - strong.first[row]);
  };
  for (Index row = 0; row < count; ++row) {
    const std::span<const Index> around = neighbours(row);
    const auto isFree = [&](Index v) { return of[v] == kNoIndex; };
    if (!isFree(row) || !std::all_of(around.begin(), around.end(), isFree)) continue;
    for (const Index v : around) of[v] = aggregates;
    of[row] = aggregates++;
  }
  const std::vector<Index> first = of;
  for (Index row = 0; row < count; ++row) {
    if (of[row] != kNoIndex) continue;
    double strongest = 0;
    for (std::size_t i = strong.first[row]; i < strong.first[row + 1]; ++i) {
      if (first[strong.column[i]] == kNoIndex || -strong.value[i] <= strongest) continue;
      strongest = -strong.value[i];
      of[row] = first[strong.column[i]];
    }
  }
  for (Index row = 0; row < count; ++row) {
    if (of[row] != kNoIndex) continue;
    for (const Index v : neighbours(row)) {
      if (of[v] == kNoIndex) of[v] = aggregates;
    }
    of[row] = aggregates++;
  }
  return aggregates;
}

// What each unknown takes from the aggregates: a step of damped Jacobi over their indicator functions. Rows sum to 1.
SparseRows prolongation(const Links& links, const std::vector<Index>& aggregateOf, Index aggregates) {
  const SparseRows& strong = links.strong;
  double largest = 1;  // eigenvalue, by Gershgorin's circles
  for (Index row = 0; row < strong.rowCount(); ++row) {
    if (!(links.diagonal[row] > 0)) continue;
    double sum = links.diagonal[row];
    for (std::size_t i = strong.first[row]; i < strong.first[row + 1]; ++i) sum += std::abs(strong.value[i]);
    largest = std::max(largest, sum / links.diagonal[row]);
  }
  const double damping = kSmoothing / largest;
  return filledRows(strong.rowCount(), aggregates, [&] {
    return [&, entries = std::vector<std::pair<Index, double>>()](Index row, std::vector<Index>& columns,
                                                                  std::vector<double>& values) mutable {
      entries.assign(1, {aggregateOf[row], 1.0});
      if (links.diagonal[row] > 0) {
        entries[0].second -= damping;
        for (std::size_t i = strong.first[row]; i < strong.first[row + 1]; ++i) {
          entries.push_back({aggregateOf[strong.column[i]], -damping / links.diagonal[row] * strong.value[i]});
        }
      }
      std::sort(entries.begin(), entries.end());
      for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i > 0 && entries[i].first == entries[i - 1].first) {
          values.back() += entries[i].second;
        } else {
          columns.push_back(entries[i].first);
          values.push_back(entries[i].second);
        }
      }
    };
  });
}

}  // namespace

SparseRows rowsOf(const Eigen::SparseMatrix<double>& lower) {
  const Index count = static_cast<Index>(lower.cols());
  SparseRows result;
  result.columnCount = count;
  result.first.assign(count + std::size_t{1}, 0);
  const auto eachEntry = [&](const auto& visit) {
    for (int column = 0; column < lower.outerSize(); ++column) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(lower, column); it; ++it) {
        if (it.row() < column) continue;
        visit(static_cast<Index>(it.row()), static_cast<Index>(column), it.value());
        if (it.row() > column) visit(static_cast<Index>(column), static_cast<Index>(it.row()), it.value());
      }
    }
  };
  eachEntry([&](Index row, Index, double) { ++result.first[row + std::size_t{1}]; });
  for (std::size_t row = 1; row < result.first.size(); ++row) result.first[row] += result.first[row - 1];
  result.column.resize(result.first.back());
  result.value.resize(result.first.back());
  std::vector<std::size_t> next(result.first.begin(), result.first.end() - 1);
  // By ascending columns of the lower triangle, so that a row gets what is left of its diagonal first, in order.
  eachEntry([&](Index row, Index column, double value) {
    const std::size_t at = next[row]++;
    result.column[at] = column;
    result.value[at] = value;
  });
  return result;
}

Eigen::SparseMatrix<double> lowerTriangle(const SparseRows& symmetric) {
  Eigen::SparseMatrix<double> lower(symmetric.rowCount(), symmetric.columnCount);
  for (Index row = 0; row < symmetric.rowCount(); ++row) {  // of a symmetric matrix, so rows serve as columns
    lower.startVec(static_cast<int>(row));
    for (std::size_t i = symmetric.first[row]; i < symmetric.first[row + 1]; ++i) {
      if (symmetric.column[i] < row) continue;
      lower.insertBack(static_cast<int>(symmetric.column[i]), static_cast<int>(row)) = symmetric.value[i];
    }
  }
  lower.finalize();
  return lower;
}

std::vector<Index> breadthFirst(const SparseRows& matrix) {
  std::vector<Index> order;
  order.reserve(matrix.rowCount());
  std::vector<char> seen(matrix.rowCount(), 0);
  for (Index start = 0; start < matrix.rowCount(); ++start) {
    if (seen[start]) continue;
    seen[start] = 1;
    order.push_back(start);
    for (std::size_t next = order.size() - 1; next < order.size(); ++next) {
      const Index row = order[next];
      for (std::size_t i = matrix.first[row]; i < matrix.first[row + 1]; ++i) {
        if (seen[matrix.column[i]]) continue;
        seen[matrix.column[i]] = 1;
        order.push_back(matrix.column[i]);
      }
    }
  }
  return order;
}

SparseRows reordered(const SparseRows& matrix, const std::vector<Index>& order) {
  std::vector<Index> rowOf(order.size());
  for (Index row = 0; row < order.size(); ++row) rowOf[order[row]] = row;
  return filledRows(matrix.rowCount(), matrix.columnCount, [&] {
    return [&, entries = std::vector<std::pair<Index, double>>()](Index row, std::vector<Index>& columns,
                                                                  std::vector<double>& values) mutable {
      entries.clear();
      const Index from = order[row];
      for (std::size_t i = matrix.first[from]; i < matrix.first[from + 1]; ++i) {
        entries.push_back({rowOf[matrix.column[i]], matrix.value[i]});
      }
      std::sort(entries.begin(), entries.end());
      for (const auto& [column, value] : entries) {
        columns.push_back(column);
        values.push_back(value);
      }
    };
  });
}

std::optional<CoarserMatrix> coarserMatrix(const SparseRows& matrix, double strongLinks) {
  CoarserMatrix coarser;
  {
    const Links links = linksOf(matrix, strongLinks);
    std::vector<Index> aggregateOf;
    const Index aggregates = aggregate(links.strong, aggregateOf);
    if (aggregates > kMinShrinking * matrix.rowCount()) return std::nullopt;
    coarser.prolong = prolongation(links, aggregateOf, aggregates);
  }
  coarser.matrix = product(transposed(coarser.prolong), product(matrix, coarser.prolong));
  return coarser;
}

}  // namespace limber
