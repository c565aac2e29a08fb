#include "limber/evaluate/group_summary.h"

#include <numeric>

#include "limber/evaluate/median.h"

namespace limber {

Cell summaryOf(const std::vector<double>& values, Statistic statistic, const NumberFormat& format) {
  if (values.empty()) return {};
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const double mean = sum / static_cast<double>(values.size()), worst = *std::max_element(values.begin(), values.end());
  Cell cell = statistic == Statistic::kSum      ? sum
              : statistic == Statistic::kMedian ? median(values)
              : statistic == Statistic::kWorst  ? worst
                                                : mean;
  cell.text = formatted(*cell.number, format);
  if (statistic == Statistic::kMeanAndWorst) *cell.text += " (" + formatted(worst, format) + ")";
  return cell;
}

}  // namespace limber
