#include "limber/evaluate/rig/template_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/text/split_text.h"

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

bool isNear(const TemplateTrial& trial) {
  return trial.row.comparison.withoutFingers.jointToJoint <= kRigIsOff;
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

std::vector<const TemplateTrial*> ofSplit(std::span<const TemplateTrial> trials, const std::string& split) {
  std::vector<const TemplateTrial*> chosen;
  for (const TemplateTrial& trial : trials) {
    if (trial.file.split == split) chosen.push_back(&trial);
  }
  return chosen;
}

std::string meanOf(const std::vector<double>& values) {
  if (values.empty()) return "-";
  double sum = 0;
  for (const double value : values) sum += value;
  return fmt::format("{:.2f} ({:.2f})", sum / static_cast<double>(values.size()),
                     *std::max_element(values.begin(), values.end()));
}

struct Column {
  Fraction kind, sure, sureAndWrong;
  std::vector<double> all, templates, handles, named, seconds;

  explicit Column(const std::vector<const TemplateTrial*>& trials) {
    for (const TemplateTrial* trial : trials) {
      kind.add(kindIsRight(*trial));
      sure.add(!trial->row.fit.isAbstained);
      if (!trial->row.fit.isAbstained) sureAndWrong.add(!suits(*trial) || !isNear(*trial));
      seconds.push_back(trial->row.seconds);
      const RigComparison& c = trial->row.comparison;
      all.push_back(c.withoutFingers.jointToJoint);
      (trial->row.fit.isAbstained ? handles : templates).push_back(c.withoutFingers.jointToJoint);
      if (!trial->row.fit.isAbstained && !c.named.empty()) named.push_back(c.namedMean);
    }
  }
};

std::string summary(std::span<const TemplateTrial> trials, const std::set<std::string>& splits) {
  std::vector<Column> columns;
  std::string head = "| measure |", rule = "|---|";
  for (const std::string& split : splits) {
    columns.emplace_back(ofSplit(trials, split));
    head += fmt::format(" {} |", split);
    rule += "---|";
  }
  std::string table = head + "\n" + rule + "\n";
  const auto row = [&](std::string_view title, auto text) {
    table += fmt::format("| {} |", title);
    for (const Column& column : columns) table += fmt::format(" {} |", text(column));
    table += "\n";
  };
  row("kind told right", [](const Column& c) { return fractionText(c.kind); });
  row("a template is taken", [](const Column& c) { return fractionText(c.sure); });
  row(fmt::format("of these wrong (kind, or J2J above {:.0f} %)", kRigIsOff),
      [](const Column& c) { return fractionText(c.sureAndWrong); });
  row("J2J without fingers, %, mean (worst)", [](const Column& c) { return meanOf(c.all); });
  row("of templates", [](const Column& c) { return meanOf(c.templates); });
  row("of handles", [](const Column& c) { return meanOf(c.handles); });
  row("joints of the same meaning, % of the height", [](const Column& c) { return meanOf(c.named); });
  row("seconds", [](const Column& c) { return meanOf(c.seconds); });
  return table;
}

// Of bodies that a template suits and of those that none does: whoever is sure there is wrong.
std::string reliability(std::span<const TemplateTrial> trials, const std::set<std::string>& splits) {
  std::string table = "| confidence |", rule = "|---|";
  for (const std::string& split : splits) {
    table += fmt::format(" {}: likeliest kind is right |", split);
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (std::size_t bin = 0; bin + 1 < kBins.size(); ++bin) {
    table += fmt::format("| {:.1f} to {:.1f} |", kBins[bin], kBins[bin + 1]);
    for (const std::string& split : splits) {
      Fraction fraction;
      for (const TemplateTrial* trial : ofSplit(trials, split)) {
        const bool isLast = bin + 2 == kBins.size();
        if (trial->row.fit.confidence < kBins[bin] || (!isLast && trial->row.fit.confidence >= kBins[bin + 1]))
          continue;
        fraction.add(suits(*trial));
      }
      table += fmt::format(" {} |", fractionText(fraction));
    }
    table += "\n";
  }
  return table;
}

std::string confusion(std::span<const TemplateTrial> trials) {
  std::set<std::string> kinds, reported = {"handles"};
  std::map<std::pair<std::string, std::string>, int> counts;
  for (const TemplateTrial& trial : trials) {
    const std::string by = trial.row.fit.isAbstained ? "handles" : std::string(kindOfTemplate(trial.row.fit.likeliest));
    kinds.insert(trial.file.kind);
    reported.insert(by);
    ++counts[{trial.file.kind, by}];
  }
  std::string table = "| kind |", rule = "|---|";
  for (const std::string& by : reported) {
    table += fmt::format(" {} |", by);
    rule += "---|";
  }
  table += "\n" + rule + "\n";
  for (const std::string& kind : kinds) {
    table += fmt::format("| {} |", kind);
    for (const std::string& by : reported) {
      const auto found = counts.find({kind, by});
      table += found == counts.end() ? " |" : fmt::format(" {} |", found->second);
    }
    table += "\n";
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

std::string templateTables(std::span<const TemplateTrial> trials) {
  std::set<std::string> splits;
  for (const TemplateTrial& trial : trials) splits.insert(trial.file.split);
  return summary(trials, splits) + "\n" + reliability(trials, splits) + "\n" + confusion(trials);
}

std::string eachTemplateTrial(std::span<const TemplateTrial> trials) {
  std::string text =
      "path\tsplit\tkind\tlikeliest\tconfidence\tabstained\tkind_right\tj2j\tnamed_mean\tnamed_worst\tseconds\n";
  for (const TemplateTrial& trial : trials) {
    text += fmt::format("{}\t{}\t{}\t{}\t{:.3f}\t{}\t{}", trial.file.path, trial.file.split, trial.file.kind,
                        trial.row.fit.likeliest, trial.row.fit.confidence, trial.row.fit.isAbstained ? 1 : 0,
                        kindIsRight(trial) ? 1 : 0);
    const RigComparison& c = trial.row.comparison;
    text += fmt::format("\t{:.2f}\t{:.2f}\t{:.2f}\t{:.2f}\n", c.withoutFingers.jointToJoint, c.namedMean, c.namedWorst,
                        trial.row.seconds);
  }
  return text;
}

std::string riggerTable(std::span<const RiggerTrial> all) {
  const std::vector<RiggerTrial> trials = ofCommonFiles(all);
  std::vector<std::string> groups, riggers;
  const auto addNew = [](const std::string& name, std::vector<std::string>& names) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const RiggerTrial& trial : trials) {
    addNew(trial.group, groups);
    addNew(trial.rigger, riggers);
  }
  std::string table =
      "| files | rigger | joints for one of the artist's | J2J | J2B | B2B | precision | recall | IoU | inside | s |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& group : groups) {
    for (const std::string& rigger : riggers) {
      std::array<double, 9> sums = {};
      std::size_t count = 0;
      for (const RiggerTrial& trial : trials) {
        if (trial.group != group || trial.rigger != rigger) continue;
        const RigDistances& d = trial.row.comparison.withoutFingers;
        const std::array<double, 9> values = {d.truthJoints > 0 ? static_cast<double>(d.joints) / d.truthJoints : 0,
                                              d.jointToJoint,
                                              d.jointToBone,
                                              d.boneToBone,
                                              d.precision,
                                              d.recall,
                                              d.iou,
                                              trial.inside,
                                              trial.row.seconds};
        for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
        ++count;
      }
      if (count == 0) continue;
      table += fmt::format("| {} ({}) | {} |", group, count, rigger);
      for (const double sum : sums) table += fmt::format(" {:.2f} |", sum / static_cast<double>(count));
      table += "\n";
    }
  }
  return table;
}

}  // namespace limber
