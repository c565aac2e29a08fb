// All rankings of a study: what its page and its summary say, each in its own form.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "limber/study/ranking/method_ranking.h"

namespace limber {

struct GroupRankings {
  std::string name;               // of the folder; empty: over all
  std::vector<Ranking> rankings;  // of each measure that some method has over all; empty where none has it here
};

struct KindRankings {
  CellKind kind = CellKind::kRig;
  std::vector<std::string> methods;   // in the order of the study
  std::vector<GroupRankings> groups;  // over all, then each folder where there are several
};

// Of the kinds of cells that have any value of a measure with a better side.
std::vector<KindRankings> studyRankings(const StudyResult& study);

std::string_view kindTitle(CellKind kind);         // "Rigs", "Retargeting"
std::string measureTitle(const Measure& measure);  // "joints in common (0 to 1; more is better)"
std::string numberText(double value);              // "3.125", "failed" where it is infinite

}  // namespace limber
