#include "limber/study/ranking/study_rankings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace limber {

namespace {

void addOnce(std::vector<std::string>& names, std::string name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
}

KindRankings rankingsOf(const StudyResult& study, CellKind kind) {
  KindRankings result;
  result.kind = kind;
  std::vector<std::string> folders;
  for (const StudyCell& cell : study.cells) {
    if (cell.kind != kind) continue;
    addOnce(result.methods, cell.method());
    addOnce(folders, cell.group);
  }
  GroupRankings all;
  for (const Measure& measure : studyMeasures()) {
    if (measure.better == Better::kNeither) continue;
    Ranking ranking = rankMethods(study, kind, measure);
    if (!ranking.scores.empty()) all.rankings.push_back(std::move(ranking));
  }
  result.groups.push_back(std::move(all));
  for (std::size_t f = 0; folders.size() > 1 && f < folders.size(); ++f) {
    GroupRankings group{folders[f], {}};
    for (const Ranking& ranking : result.groups.front().rankings) {
      group.rankings.push_back(rankMethods(study, kind, *ranking.measure, folders[f]));
    }
    result.groups.push_back(std::move(group));
  }
  return result;
}

}  // namespace

std::vector<KindRankings> studyRankings(const StudyResult& study) {
  std::vector<KindRankings> kinds;
  for (const CellKind kind : {CellKind::kRig, CellKind::kRetarget}) {
    KindRankings one = rankingsOf(study, kind);
    if (!one.groups.front().rankings.empty()) kinds.push_back(std::move(one));
  }
  return kinds;
}

std::string_view kindTitle(CellKind kind) {
  return kind == CellKind::kRig ? "Rigs" : "Retargeting";
}

std::string measureTitle(const Measure& measure) {
  const std::string unit = measure.unit.empty() ? std::string() : std::string(measure.unit) + "; ";
  return fmt::format("{} ({}{} is better)", measure.label, unit, measure.better == Better::kMore ? "more" : "less");
}

std::string numberText(double value) {
  return std::isfinite(value) ? fmt::format("{:.4g}", value) : "failed";
}

}  // namespace limber
