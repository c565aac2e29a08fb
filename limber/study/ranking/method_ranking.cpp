#include "limber/study/ranking/method_ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "limber/core/error.h"
#include "limber/evaluate/median.h"

namespace limber {

namespace {

constexpr std::size_t kWorstCells = 10;
constexpr double kFailure = std::numeric_limits<double>::infinity();

bool asksFor(const StudyCell& cell, const Measure& measure) {
  return std::any_of(cell.steps.begin(), cell.steps.end(), [&](const CellStep& step) {
    return measure.source == MeasureSource::kClock ? step.isTimed : includes(step.measures, measure);
  });
}

// Methods and subjects in the order in which they come; the number of the cell of each two.
struct Grid {
  std::vector<std::string> methods, subjects;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> cellOf;  // of method, subject
};

std::size_t indexIn(std::vector<std::string>& names, std::map<std::string, std::size_t>& indices,
                    const std::string& name) {
  const auto [found, isNew] = indices.try_emplace(name, names.size());
  if (isNew) names.push_back(name);
  return found->second;
}

// What the joints of a cell's rig depend on: rigger and options, which may tell how many.
std::string jointsOf(const StudyCell& cell) {
  return cell.rigger + ", " + cell.options;
}

// The joints (jointsOf) that the most methods have in common, at least two; the first of several.
std::optional<std::string> sharedJoints(const StudyResult& study, CellKind kind, const Measure& measure) {
  std::vector<std::pair<std::string, std::vector<std::string>>> methodsOf;  // by joints, in the study's order
  for (const StudyCell& cell : study.cells) {
    if (cell.kind != kind || !asksFor(cell, measure)) continue;
    const auto isIts = [&](const auto& entry) { return entry.first == jointsOf(cell); };
    auto entry = std::find_if(methodsOf.begin(), methodsOf.end(), isIts);
    if (entry == methodsOf.end()) entry = methodsOf.insert(entry, {jointsOf(cell), {}});
    std::vector<std::string>& methods = entry->second;
    if (std::find(methods.begin(), methods.end(), cell.method()) == methods.end()) methods.push_back(cell.method());
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); };
  const auto most = std::max_element(methodsOf.begin(), methodsOf.end(), fewer);
  if (most == methodsOf.end() || most->second.size() < 2) return std::nullopt;
  return most->first;
}

Grid gridOf(const StudyResult& study, CellKind kind, const Measure& measure, const std::string& group) {
  Grid grid;
  const std::optional<std::string> joints = measure.needsSameJoints ? sharedJoints(study, kind, measure) : std::nullopt;
  if (measure.needsSameJoints && !joints) return grid;
  std::map<std::string, std::size_t> methods, subjects;
  for (std::size_t i = 0; i < study.cells.size(); ++i) {
    const StudyCell& cell = study.cells[i];
    if (cell.kind != kind || !asksFor(cell, measure) || (!group.empty() && cell.group != group)) continue;
    if (joints && jointsOf(cell) != *joints) continue;
    const std::size_t method = indexIn(grid.methods, methods, cell.method());
    grid.cellOf.try_emplace({method, indexIn(grid.subjects, subjects, cell.subject())}, i);
  }
  return grid;
}

// Values of which less is better: #methods x #subjects that count, kFailure where a method gave none, none where it was
// not tried.
using Losses = std::vector<std::vector<std::optional<double>>>;

Losses lossesOf(const StudyResult& study, const Grid& grid, const Measure& measure) {
  const double sign = measure.better == Better::kMore ? -1 : 1;
  Losses losses(grid.methods.size());
  for (std::size_t s = 0; s < grid.subjects.size(); ++s) {
    std::vector<std::optional<double>> column(grid.methods.size());
    bool counts = false;
    for (std::size_t m = 0; m < grid.methods.size(); ++m) {
      const auto cell = grid.cellOf.find({m, s});
      if (cell == grid.cellOf.end()) continue;
      const std::optional<double> value = study.results[cell->second].valueOf(measure);
      column[m] = value ? sign * *value : kFailure;
      counts = counts || value;
    }
    for (std::size_t m = 0; counts && m < column.size(); ++m) losses[m].push_back(column[m]);
  }
  return losses;
}

MethodScore scoreFrom(const std::string& method, const std::vector<std::optional<double>>& losses) {
  MethodScore score;
  score.method = method;
  std::vector<double> tried;
  for (const std::optional<double>& loss : losses) {
    if (!loss) continue;
    tried.push_back(*loss);
    score.failures += *loss == kFailure ? 1 : 0;
  }
  score.subjects = tried.size();
  if (!tried.empty()) score.value = bootstrapMedian(tried);
  return score;
}

MethodPair pairOf(const std::string& first, const std::string& second, const std::vector<std::optional<double>>& a,
                  const std::vector<std::optional<double>>& b) {
  MethodPair pair{first, second};
  std::vector<double> differences;
  for (std::size_t s = 0; s < a.size(); ++s) {
    if (!a[s] || !b[s]) continue;
    differences.push_back(*b[s] - *a[s]);
    (*a[s] < *b[s] ? pair.firstWins : *b[s] < *a[s] ? pair.secondWins : pair.ties) += 1;
  }
  pair.p = signedRankP(differences);
  pair.isTurned = signedRankSide(differences) < 0;
  return pair;
}

// Values as they are measured again, not as losses.
void turnBack(MethodScore& score) {
  MedianInterval& value = score.value;
  value = {-value.median, -value.high, -value.low};
}

double medianSeconds(const StudyResult& study, const Grid& grid, std::size_t method) {
  std::vector<double> seconds;
  for (std::size_t s = 0; s < grid.subjects.size(); ++s) {
    const auto cell = grid.cellOf.find({method, s});
    if (cell == grid.cellOf.end()) continue;
    if (const auto value = study.results[cell->second].valueOf(findMeasure("seconds"))) seconds.push_back(*value);
  }
  return seconds.empty() ? 0 : median(seconds);
}

std::vector<std::size_t> worstCells(const StudyResult& study, const Grid& grid, const Measure& measure) {
  std::vector<std::pair<double, std::size_t>> losses;
  for (const auto& [pair, cell] : grid.cellOf) {
    const std::optional<double> value = study.results[cell].valueOf(measure);
    if (value) losses.push_back({measure.better == Better::kMore ? *value : -*value, cell});
  }
  std::sort(losses.begin(), losses.end());
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < std::min(kWorstCells, losses.size()); ++i) cells.push_back(losses[i].second);
  return cells;
}

}  // namespace

void correctForAll(std::span<MethodPair> pairs) {
  std::vector<double> p;
  for (const MethodPair& pair : pairs) p.push_back(pair.p);
  const std::vector<double> corrected = holmCorrected(p);
  for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].p = corrected[i];
}

Table pairTable(std::span<const MethodPair> pairs, std::string_view ties) {
  Table table{{words("method"), words("against"), number("better", 0), number("worse", 0), number(std::string(ties), 0),
               significant("p", 3)}};
  for (const MethodPair& pair : pairs) {
    table.add({foreign(pair.first), foreign(pair.second), pair.firstWins, pair.secondWins, pair.ties, pair.p},
              pair.first + " " + pair.second);
  }
  return table;
}

const MethodScore* Ranking::scoreOf(std::string_view method) const {
  const auto score = std::find_if(scores.begin(), scores.end(), [&](const auto& s) { return s.method == method; });
  return score == scores.end() ? nullptr : &*score;
}

Ranking rankMethods(const StudyResult& study, CellKind kind, const Measure& measure, const std::string& group) {
  if (measure.better == Better::kNeither) throw Error(ErrorCode::kBadArgument, "the measure has no better side");
  Ranking ranking;
  ranking.measure = &measure;
  const Grid grid = gridOf(study, kind, measure, group);
  const Losses losses = lossesOf(study, grid, measure);
  struct Ranked {
    MethodScore score;
    std::size_t method;
  };
  std::vector<Ranked> ranked;
  for (std::size_t m = 0; m < grid.methods.size(); ++m) {
    MethodScore score = scoreFrom(grid.methods[m], losses[m]);
    if (score.subjects == 0) continue;
    score.seconds = medianSeconds(study, grid, m);
    ranked.push_back({std::move(score), m});
  }
  if (measure.ranks) {
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Ranked& a, const Ranked& b) { return a.score.value.median < b.score.value.median; });
  }
  for (std::size_t i = 0; measure.ranks && i < ranked.size(); ++i) {
    for (std::size_t j = i + 1; j < ranked.size(); ++j) {
      ranking.pairs.push_back(
          pairOf(ranked[i].score.method, ranked[j].score.method, losses[ranked[i].method], losses[ranked[j].method]));
    }
  }
  correctForAll(ranking.pairs);
  for (Ranked& one : ranked) {
    if (measure.better == Better::kMore) turnBack(one.score);
    ranking.scores.push_back(std::move(one.score));
  }
  if (measure.ranks && !ranking.scores.empty()) ranking.worstCells = worstCells(study, grid, measure);
  return ranking;
}

}  // namespace limber
