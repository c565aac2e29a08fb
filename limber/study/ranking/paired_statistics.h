// What can be said of methods that were tried on the same subjects. Values may be infinite: a method that failed counts
// as worse than any that did not.
#pragma once

#include <span>
#include <vector>

namespace limber {

struct MedianInterval {
  double median = 0, low = 0, high = 0;
};

// The median, and the percentile bootstrap's 95 % interval of it: 2000 samples, seed 1 (Efron, Tibshirani 1993). At
// least one value; infinite ones all of one sign.
MedianInterval bootstrapMedian(std::span<const double> values);

// Each value's rank from 0, ties at their mean.
std::vector<double> meanRanks(std::span<const double> values);

// The limits of the middle 95 % of samples.
struct Interval {
  double low = 0, high = 0;
};
Interval percentileInterval(std::vector<double> samples);

// The two-sided p-value of Wilcoxon's signed rank test: how likely differences so far to one side are where both
// methods are the same. Zeros, and differences of two infinities, are left out; ties get mean ranks. Exact (over all
// signs) up to 200 differences, from there on by the normal distribution with corrections for ties and continuity. 1
// without any.
double signedRankP(std::span<const double> differences);

// To which side signedRankP's differences are: 1, -1, or 0 where their ranks add up to the same on both.
int signedRankSide(std::span<const double> differences);

// Each p-value corrected for there being several of them (Holm 1979), in their order; at most 1.
std::vector<double> holmCorrected(std::span<const double> pValues);

}  // namespace limber
