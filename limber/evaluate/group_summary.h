// Tables over many files: a measure of each file, and what is made of it over a group of them.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limber/report/table.h"

namespace limber {

enum class Statistic { kMean, kMedian, kWorst, kSum, kMeanAndWorst };

// Of the values, as a table has it: the worst is the largest, in brackets behind a mean. Nothing where there are none.
Cell summaryOf(const std::vector<double>& values, Statistic statistic, const NumberFormat& format);

// A column of a table with a line for each group of rows.
template <typename Row>
struct RowMeasure {
  std::string name;
  NumberFormat format;
  Statistic statistic;
  std::function<std::optional<double>(const Row&)> value;  // nothing: the row does not count
};

template <typename Row>
using RowGroup = std::vector<const Row*>;

template <typename Row>
Cell summaryOf(const RowGroup<Row>& group, const RowMeasure<Row>& measure) {
  std::vector<double> values;
  for (const Row* row : group) {
    if (const std::optional<double> value = measure.value(*row)) values.push_back(*value);
  }
  return summaryOf(values, measure.statistic, measure.format);
}

// The rows of which `isIn` is true, in their order.
template <typename Row, typename IsIn>
RowGroup<Row> rowsWhere(std::span<const Row> rows, const IsIn& isIn) {
  RowGroup<Row> group;
  for (const Row& row : rows) {
    if (isIn(row)) group.push_back(&row);
  }
  return group;
}

// What a member holds, each once, in the order in which it comes first.
template <typename Row>
std::vector<std::string> namesIn(std::span<const Row> rows, std::string Row::*member) {
  std::vector<std::string> names;
  for (const Row& row : rows) {
    if (std::find(names.begin(), names.end(), row.*member) == names.end()) names.push_back(row.*member);
  }
  return names;
}

// The columns of the measures behind others.
template <typename Row>
Table summaryTable(std::vector<Column> columns, const std::vector<RowMeasure<Row>>& measures) {
  for (const RowMeasure<Row>& measure : measures) columns.push_back({measure.name, measure.format});
  return {std::move(columns)};
}

// A line of such a table; none for an empty group.
template <typename Row>
void addSummary(std::vector<Cell> cells, const RowGroup<Row>& group, const std::vector<RowMeasure<Row>>& measures,
                Table& table) {
  if (group.empty()) return;
  for (const RowMeasure<Row>& measure : measures) cells.push_back(summaryOf(group, measure));
  table.add(std::move(cells));
}

}  // namespace limber
