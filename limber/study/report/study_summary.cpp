#include "limber/study/report/study_summary.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/report/escaped_text.h"
#include "limber/report/table.h"
#include "limber/study/ranking/study_rankings.h"

namespace limber {

namespace {

constexpr double kSignificant = 0.05;  // p, the usual level

// A table holds what one command measures.
constexpr std::pair<MeasureSource, std::string_view> kTables[] = {
    {MeasureSource::kSkeletonTruth, "Skeletons against the artist's"},
    {MeasureSource::kWeightTruth, "Weights against the artist's"},
    {MeasureSource::kModel, "Rigs with nothing to compare them with"},
    {MeasureSource::kModelMotion, "The surface in motion"},
    {MeasureSource::kMotion, "Motions"}};

using Columns = std::vector<const Ranking*>;

Columns columnsOf(const GroupRankings& group, MeasureSource source, bool ranks) {
  Columns columns;
  for (const Ranking& ranking : group.rankings) {
    const bool isIn = ranking.measure->source == source && ranking.measure->ranks == ranks;
    if (isIn && !ranking.scores.empty()) columns.push_back(&ranking);
  }
  return columns;
}

// "6.45 (4.42 to 9.21), 2 of 40 failed"
Cell scoreCell(const MethodScore* score) {
  if (!score) return {};
  const MedianInterval& value = score->value;
  std::string text =
      fmt::format("{} ({} to {})", numberText(value.median), numberText(value.low), numberText(value.high));
  if (score->failures > 0) text += fmt::format(", {} of {} failed", score->failures, score->subjects);
  return text;
}

Cell timeCell(const GroupRankings& group, const std::string& method) {
  for (const Ranking& ranking : group.rankings) {
    const MethodScore* score = ranking.scoreOf(method);
    if (score && score->seconds > 0) return numberText(score->seconds);
  }
  return {};
}

std::string tableText(const KindRankings& kind, const GroupRankings& group, const Columns& columns,
                      const SummaryOptions& options) {
  Table table{{words("method")}};
  for (const Ranking* ranking : columns) table.columns.push_back(words(measureTitle(*ranking->measure)));
  if (options.hasTimes) table.columns.push_back(words("time (s)"));
  for (const std::string& method : kind.methods) {
    const auto has = [&](const Ranking* ranking) { return ranking->scoreOf(method) != nullptr; };
    if (std::none_of(columns.begin(), columns.end(), has)) continue;
    std::vector<Cell> cells = {foreign(method)};
    for (const Ranking* ranking : columns) cells.push_back(scoreCell(ranking->scoreOf(method)));
    if (options.hasTimes) cells.push_back(timeCell(group, method));
    table.add(std::move(cells));
  }
  return toMarkdown(table) + "\n";
}

std::string pText(double p) {
  constexpr double kMinShown = 0.001;
  return p < kMinShown ? fmt::format("p below {}", kMinShown) : fmt::format("p = {:.3f}", p);
}

// The one that the test says is better comes first, whatever the medians.
std::string pairText(const Measure& measure, const MethodPair& pair) {
  const std::size_t all = pair.firstWins + pair.secondWins + pair.ties;
  const std::string &better = pair.isTurned ? pair.second : pair.first,
                    &worse = pair.isTurned ? pair.first : pair.second;
  return fmt::format("- {}: {} before {} on {} of {}, behind on {}, {}\n", measure.label, markdownText(better),
                     markdownText(worse), pair.isTurned ? pair.secondWins : pair.firstWins, all,
                     pair.isTurned ? pair.firstWins : pair.secondWins, pText(pair.p));
}

// Which methods of a table are told apart.
std::string pairsText(const Columns& columns) {
  std::string lines;
  bool hasPairs = false;
  for (const Ranking* ranking : columns) {
    for (const MethodPair& pair : ranking->pairs) {
      hasPairs = true;
      if (pair.p < kSignificant) lines += pairText(*ranking->measure, pair);
    }
  }
  if (!hasPairs) return {};
  if (lines.empty()) return "No two methods are told apart.\n\n";
  return "Methods that are told apart:\n\n" + lines + "\n";
}

std::string groupText(const KindRankings& kind, const GroupRankings& group, const SummaryOptions& options) {
  const std::string folder = group.name.empty() ? "all models" : markdownText(group.name);
  std::string text;
  for (const auto& [source, title] : kTables) {
    for (const bool ranks : {true, false}) {
      const Columns columns = columnsOf(group, source, ranks);
      if (columns.empty()) continue;
      text += fmt::format("### {}{}\n\n", title, ranks ? "" : " (ranks nothing)");
      text += tableText(kind, group, columns, options);
      if (ranks) text += pairsText(columns);
    }
  }
  return text.empty() ? text : fmt::format("## {}: {}\n\n", kindTitle(kind.kind), folder) + text;
}

// A line for each method with cells that did not end well.
std::string failuresText(const StudyResult& study, const KindRankings& kind) {
  std::string lines;
  for (const std::string& method : kind.methods) {
    std::size_t failed = 0, all = 0;
    for (std::size_t i = 0; i < study.cells.size(); ++i) {
      if (study.cells[i].kind != kind.kind || study.cells[i].method() != method) continue;
      ++all;
      failed += study.results[i].outcome != JobOutcome::kDone;
    }
    if (failed > 0) lines += fmt::format("- {}: {} of {}\n", markdownText(method), failed, all);
  }
  if (lines.empty()) return {};
  return fmt::format("## {}: cells that did not end well\n\n", kindTitle(kind.kind)) + lines + "\n";
}

}  // namespace

std::string studySummary(const StudyResult& study, const SummaryOptions& options) {
  std::string text = fmt::format(
      "# {}\n\n{}. Medians, in brackets their 95 % intervals. A method that failed on a model counts as worse there "
      "than any\nthat did not. Methods are told apart by Wilcoxon's signed rank test over the models, p after Holm "
      "below {}.\n\n",
      markdownText(study.title), counted(study.cells.size(), "cell"), kSignificant);
  for (const KindRankings& kind : studyRankings(study)) {
    for (const GroupRankings& group : kind.groups) text += groupText(kind, group, options);
    text += failuresText(study, kind);
  }
  text.pop_back();
  return text;
}

}  // namespace limber
