// How far measures that need no truth agree with those that know it: which of them can be believed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "limber/report/table.h"
#include "limber/study/measure.h"

namespace limber {

// Spearman's rank correlation, -1 to 1: Pearson's of the ranks, ties at their mean. Nothing where either has one value
// alone. Both spans have the same size.
std::optional<double> rankCorrelation(std::span<const double> a, std::span<const double> b);

// Of a measure without a truth and one that knows it, over the methods tried on one model, then the mean over the
// models. Positive: what is better by the one tends to be so by the other.
struct MeasureAgreement {
  const Measure* measure = nullptr;  // of MeasureSource::kModel or kModelMotion
  const Measure* truth = nullptr;    // of kSkeletonTruth or kWeightTruth
  std::size_t models = 0;            // that have three methods or more with both, not all alike
  double correlation = 0;
};

// cells  documents as cellsJson writes them. Those of several studies are other models.
// Pairs without any model are left out; in the measures' order. Throws Error kBadData where a document is none such.
std::vector<MeasureAgreement> measureAgreement(std::span<const Json> cells);

// A line for each measure without a truth, a column for each that knows it.
Table agreementTable(std::span<const MeasureAgreement> agreements);

}  // namespace limber
