#include "limber/evaluate/rig/template_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/text/split_text.h"
#include "limber/evaluate/group_summary.h"

namespace limber {

namespace {

constexpr std::array<double, 6> kBins = {0, 0.2, 0.4, 0.6, 0.8, 1};  // of the confidence

std::string_view cellOf(const std::vector<std::string_view>& cells, std::size_t column) {
  if (column >= cells.size()) return {};
  std::string_view cell = cells[column];
  if (cell.ends_with('\r')) cell.remove_suffix(1);
  return cell;
}

bool suits(const TemplateTrial& trial) {
  const auto right = templatesFor(trial.file.kind);
  return std::find(right.begin(), right.end(), trial.row.fit.likeliest) != right.end();
}

// "humanoid" whatever its fingers.
std::string_view kindOfTemplate(std::string_view name) {
  return name.starts_with("humanoid") ? "humanoid" : name;
}

double distanceOf(const TemplateTrial& trial) {
  return trial.row.comparison.withoutFingers.jointToJoint;
}

// Where no template suits it, handles are right.
bool kindIsRight(const TemplateTrial& trial) {
  return templatesFor(trial.file.kind).empty() ? trial.row.fit.isAbstained : !trial.row.fit.isAbstained && suits(trial);
}

struct Fraction {
  std::size_t hits = 0, all = 0;

  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++all;
  }
};

// With the 95 % confidence interval of Wilson (1927).
std::string fractionText(const Fraction& fraction) {
  if (fraction.all == 0) return "-";
  constexpr double kZ = 1.96;  // standard deviations about 95 % of a normal distribution
  const double n = static_cast<double>(fraction.all), p = static_cast<double>(fraction.hits) / n;
  const double centre = (p + kZ * kZ / (2 * n)) / (1 + kZ * kZ / n);
  const double half = kZ / (1 + kZ * kZ / n) * std::sqrt(p * (1 - p) / n + kZ * kZ / (4 * n * n));
  return fmt::format("{} of {} ({:.0f} %; {:.0f} to {:.0f})", fraction.hits, fraction.all, 100 * p,
                     100 * std::max(0.0, centre - half), 100 * std::min(1.0, centre + half));
}

using Trials = RowGroup<TemplateTrial>;

// By their names.
std::map<std::string, Trials> splitsOf(std::span<const TemplateTrial> trials) {
  std::map<std::string, Trials> splits;
  for (const TemplateTrial& trial : trials) splits[trial.file.split].push_back(&trial);
  return splits;
}

Table summary(const std::map<std::string, Trials>& splits) {
  Table table{{words("measure")}};
  for (const auto& [split, trials] : splits) table.columns.push_back(words(split));
  // Of the trials for which there is a value.
  const auto addFraction = [&](std::string name, const std::function<std::optional<bool>(const TemplateTrial&)>& hit) {
    table.addAcross(std::move(name), splits, [&](const auto& split) {
      Fraction fraction;
      for (const TemplateTrial* trial : split.second) {
        if (const std::optional<bool> is = hit(*trial)) fraction.add(*is);
      }
      return fractionText(fraction);
    });
  };
  const auto addMean = [&](std::string name, const std::function<std::optional<double>(const TemplateTrial&)>& value) {
    const RowMeasure<TemplateTrial> measure{name, decimals(2), Statistic::kMeanAndWorst, value};
    table.addAcross(std::move(name), splits, [&](const auto& split) { return summaryOf(split.second, measure); });
  };
  const auto distanceWhere = [](bool isAbstained) {
    return [=](const TemplateTrial& trial) {
      return trial.row.fit.isAbstained == isAbstained ? std::optional(distanceOf(trial)) : std::nullopt;
    };
  };
  addFraction("kind told right", kindIsRight);
  addFraction("a template is taken", [](const TemplateTrial& trial) { return !trial.row.fit.isAbstained; });
  addFraction(fmt::format("of these wrong (kind, or J2J above {:.0f} %)", kRigIsOff), [](const TemplateTrial& trial) {
    return trial.row.fit.isAbstained ? std::nullopt : std::optional(!suits(trial) || distanceOf(trial) > kRigIsOff);
  });
  addMean("J2J without fingers, %, mean (worst)", distanceOf);
  addMean("of templates", distanceWhere(false));
  addMean("of handles", distanceWhere(true));
  addMean("joints of the same meaning, % of the height", [](const TemplateTrial& trial) {
    const RigComparison& c = trial.row.comparison;
    return trial.row.fit.isAbstained || c.named.empty() ? std::nullopt : std::optional(c.namedMean);
  });
  addMean("seconds", [](const TemplateTrial& trial) { return trial.row.seconds; });
  return table;
}

// Of bodies that a template suits and of those that none does: whoever is sure there is wrong.
Table reliability(const std::map<std::string, Trials>& splits) {
  Table table{{words("confidence")}};
  for (const auto& [split, trials] : splits) table.columns.push_back(words(split + ": likeliest kind is right"));
  for (std::size_t bin = 0; bin + 1 < kBins.size(); ++bin) {
    const bool isLast = bin + 2 == kBins.size();
    table.addAcross(fmt::format("{:.1f} to {:.1f}", kBins[bin], kBins[bin + 1]), splits, [&](const auto& split) {
      Fraction fraction;
      for (const TemplateTrial* trial : split.second) {
        const double confidence = trial->row.fit.confidence;
        if (confidence >= kBins[bin] && (isLast || confidence < kBins[bin + 1])) fraction.add(suits(*trial));
      }
      return fractionText(fraction);
    });
  }
  return table;
}

Table confusion(std::span<const TemplateTrial> trials) {
  std::set<std::string> kinds, reported = {"handles"};
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const TemplateTrial& trial : trials) {
    const std::string by = trial.row.fit.isAbstained ? "handles" : std::string(kindOfTemplate(trial.row.fit.likeliest));
    kinds.insert(trial.file.kind);
    reported.insert(by);
    ++counts[{trial.file.kind, by}];
  }
  Table table{{words("kind")}};
  for (const std::string& by : reported) table.columns.push_back(number(by, 0));
  for (const std::string& kind : kinds) {
    table.addAcross(kind, reported, [&](const std::string& by) {
      const auto found = counts.find({kind, by});
      return found == counts.end() ? Cell("") : Cell(found->second);
    });
  }
  return table;
}

// Those of files that every rigger has.
std::vector<RiggerTrial> ofCommonFiles(std::span<const RiggerTrial> trials) {
  std::set<std::string> riggers;
  std::map<std::filesystem::path, std::set<std::string>> riggersOf;
  for (const RiggerTrial& trial : trials) {
    riggers.insert(trial.rigger);
    riggersOf[trial.row.path].insert(trial.rigger);
  }
  std::vector<RiggerTrial> common;
  for (const RiggerTrial& trial : trials) {
    if (riggersOf[trial.row.path].size() == riggers.size()) common.push_back(trial);
  }
  return common;
}

}  // namespace

std::vector<LabelledFile> parseLabelledFiles(std::string_view text) {
  std::vector<LabelledFile> files;
  constexpr std::array<std::string_view, 3> kColumns = {"path", "kind", "split"};
  std::array<std::size_t, 3> at = {};
  bool isHead = true;
  for (const std::string_view line : splitAt(text, '\n')) {
    const std::vector<std::string_view> cells = splitAt(line, '\t');
    if (isHead) {
      for (std::size_t c = 0; c < kColumns.size(); ++c) {
        while (at[c] < cells.size() && cellOf(cells, at[c]) != kColumns[c]) ++at[c];
        if (at[c] == cells.size()) {
          throw Error(ErrorCode::kBadData, fmt::format("has no column '{}'", kColumns[c]), {},
                      "the first line names the columns, separated by tabs: path, kind, split");
        }
      }
      isHead = false;
      continue;
    }
    if (cellOf(cells, at[0]).empty()) continue;
    files.push_back(
        {std::string(cellOf(cells, at[0])), std::string(cellOf(cells, at[1])), std::string(cellOf(cells, at[2]))});
  }
  return files;
}

std::span<const std::string_view> templatesFor(std::string_view kind) {
  static constexpr std::array<std::string_view, 2> kPeople = {"humanoid", "humanoid-fingers"};
  static constexpr std::array<std::string_view, 2> kLow = {"quadruped", "crawler"}, kLegs = {"insect", "spider"};
  static constexpr std::array<std::string_view, 1> kFourLegs = {"quadruped"}, kBirds = {"bird"}, kFish = {"fish"},
                                                   kSerpents = {"serpent"}, kDinosaurs = {"dinosaur"};
  for (const std::string_view person : {"human", "chibi", "robed-or-propped", "monster-biped", "robot"}) {
    if (kind == person) return kPeople;
  }
  if (kind == "quadruped") return kFourLegs;
  if (kind == "low-quadruped") return kLow;
  if (kind == "bird") return kBirds;
  if (kind == "fish") return kFish;
  if (kind == "serpent") return kSerpents;
  if (kind == "dinosaur-biped") return kDinosaurs;
  if (kind == "insect-or-many-legged") return kLegs;
  return {};
}

std::vector<Table> templateTables(std::span<const TemplateTrial> trials) {
  const std::map<std::string, Trials> splits = splitsOf(trials);
  return {summary(splits), reliability(splits), confusion(trials)};
}

Table eachTemplateTrial(std::span<const TemplateTrial> trials) {
  Table table{{words("path"), words("split"), words("kind"), words("likeliest"), number("confidence", 3),
               number("abstained", 0), number("kind_right", 0), number("j2j", 2), number("named_mean", 2),
               number("named_worst", 2), number("seconds", 2)}};
  for (const TemplateTrial& trial : trials) {
    const RigTableRow& row = trial.row;
    table.add({trial.file.path, trial.file.split, trial.file.kind, row.fit.likeliest, row.fit.confidence,
               row.fit.isAbstained, kindIsRight(trial), distanceOf(trial), row.comparison.namedMean,
               row.comparison.namedWorst, row.seconds});
  }
  return table;
}

Table riggerTable(std::span<const RiggerTrial> all) {
  using Trial = RiggerTrial;
  const std::vector<Trial> common = ofCommonFiles(all);
  const std::span<const Trial> trials = common;
  std::vector<RowMeasure<Trial>> measures;
  const auto add = [&](std::string name, const auto& value) {
    measures.push_back({std::move(name), decimals(2), Statistic::kMean, value});
  };
  const auto addDistance = [&](std::string name, double RigDistances::*distance) {
    add(std::move(name), [=](const Trial& trial) { return trial.row.comparison.withoutFingers.*distance; });
  };
  add("joints for one of the artist's", [](const Trial& trial) {
    const RigDistances& d = trial.row.comparison.withoutFingers;
    return d.truthJoints > 0 ? static_cast<double>(d.joints) / d.truthJoints : 0;
  });
  addDistance("J2J", &RigDistances::jointToJoint);
  addDistance("J2B", &RigDistances::jointToBone);
  addDistance("B2B", &RigDistances::boneToBone);
  addDistance("precision", &RigDistances::precision);
  addDistance("recall", &RigDistances::recall);
  addDistance("IoU", &RigDistances::iou);
  add("inside", &Trial::inside);
  add("s", [](const Trial& trial) { return trial.row.seconds; });
  Table table = summaryTable({words("files"), words("rigger")}, measures);
  for (const std::string& group : namesIn(trials, &Trial::group)) {
    for (const std::string& rigger : namesIn(trials, &Trial::rigger)) {
      const RowGroup<Trial> found =
          rowsWhere(trials, [&](const Trial& trial) { return trial.group == group && trial.rigger == rigger; });
      addSummary({fmt::format("{} ({})", group, found.size()), rigger}, found, measures, table);
    }
  }
  return table;
}

}  // namespace limber
