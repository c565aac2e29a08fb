// How the methods of a study compare in one measure.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/report/table.h"
#include "limber/study/ranking/paired_statistics.h"
#include "limber/study/study_run.h"

namespace limber {

// A method over all subjects for which at least one method gave a value. Where it has none itself it failed, and counts
// as worse than any: so that a method gains nothing by failing where the others are bad.
struct MethodScore {
  std::string method;
  std::size_t subjects = 0, failures = 0;
  MedianInterval value;  // infinite where it fails that often
  double seconds = 0;    // median of the cells that have one; 0: none has
};

// Two methods on the subjects that both were tried on.
struct MethodPair {
  std::string first, second;
  std::size_t firstWins = 0, secondWins = 0, ties = 0;
  double p = 1;           // signed rank test, corrected for all pairs of the ranking
  bool isTurned = false;  // by that test the second is the better one
};

// Holm's correction of their p for there being all of them.
void correctForAll(std::span<MethodPair> pairs);
// A line for each two; `ties` names the column of subjects on which they are equal.
Table pairTable(std::span<const MethodPair> pairs, std::string_view ties);

struct Ranking {
  const Measure* measure = nullptr;
  std::vector<MethodScore> scores;      // best first; alike ones in the order of the study
  std::vector<MethodPair> pairs;        // the first is the one that ranks higher
  std::vector<std::size_t> worstCells;  // by number, worst first: those with a value, no more than ten

  const MethodScore* scoreOf(std::string_view method) const;  // null where it has none
};

// Over the cells of a kind, in one group or, where that is empty, in all. Nothing in it where no cell has the measure.
// Of a measure that needs the same joints only methods of one rigger with the same options are in it: of those that
// most methods have in common, two at least. Of a measure that ranks nothing it has the scores alone, in the order of
// the study. The measure must have a better side.
Ranking rankMethods(const StudyResult& study, CellKind kind, const Measure& measure, const std::string& group = {});

}  // namespace limber
