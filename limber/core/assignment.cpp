#include "limber/core/assignment.h"

#include <algorithm>
#include <limits>

namespace limber {

namespace {

// With at least as many columns as rows: rows enter one by one, each along the shortest augmenting path. Prices keep
// all reduced costs positive. Column 0 and row 0 stand for "none".
std::vector<std::size_t> rowOfColumn(const std::vector<std::vector<double>>& costs, std::size_t columns) {
  const std::size_t rows = costs.size();
  std::vector<double> rowPrice(rows + 1, 0), columnPrice(columns + 1, 0);
  std::vector<std::size_t> row(columns + 1, 0), before(columns + 1, 0);
  for (std::size_t r = 1; r <= rows; ++r) {
    row[0] = r;
    std::size_t at = 0;
    std::vector<double> least(columns + 1, std::numeric_limits<double>::infinity());
    std::vector<bool> seen(columns + 1, false);
    do {
      seen[at] = true;
      double step = std::numeric_limits<double>::infinity();
      std::size_t next = 0;
      for (std::size_t c = 1; c <= columns; ++c) {
        if (seen[c]) continue;
        const double reduced = costs[row[at] - 1][c - 1] - rowPrice[row[at]] - columnPrice[c];
        if (reduced < least[c]) {
          least[c] = reduced;
          before[c] = at;
        }
        if (least[c] < step) {
          step = least[c];
          next = c;
        }
      }
      for (std::size_t c = 0; c <= columns; ++c) {
        if (seen[c]) {
          rowPrice[row[c]] += step;
          columnPrice[c] -= step;
        } else {
          least[c] -= step;
        }
      }
      at = next;
    } while (row[at] != 0);
    for (; at != 0; at = before[at]) row[at] = row[before[at]];
  }
  return row;
}

}  // namespace

std::vector<std::optional<Index>> cheapestPairs(const std::vector<std::vector<double>>& costs) {
  const std::size_t rows = costs.size(), columns = rows == 0 ? 0 : costs.front().size();
  std::vector<std::optional<Index>> partner(rows);
  if (rows <= columns) {
    const std::vector<std::size_t> row = rowOfColumn(costs, columns);
    for (std::size_t c = 1; c <= columns; ++c) {
      if (row[c] != 0) partner[row[c] - 1] = static_cast<Index>(c - 1);
    }
    return partner;
  }
  std::vector<std::vector<double>> turned(columns, std::vector<double>(rows));
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) turned[c][r] = costs[r][c];
  }
  const std::vector<std::size_t> column = rowOfColumn(turned, rows);
  for (std::size_t r = 1; r <= rows; ++r) {
    if (columns > 0 && column[r] != 0) partner[r - 1] = static_cast<Index>(column[r] - 1);
  }
  return partner;
}

}  // namespace limber
