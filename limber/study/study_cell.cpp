#include "limber/study/study_cell.h"

#include <algorithm>

#include <fmt/format.h>

namespace limber {

namespace {

constexpr std::string_view kPictureSize = "160x160", kMovingSize = "160x160", kMovingFps = "8", kPoseSize = "112x112",
                           kPoses = "4";    // of a range of motion
constexpr std::string_view kShown = "0:4";  // seconds of a motion that its picture shows

// The poses that stretch the most, by the cell's deformer. What has no part that bends has none.
void addStretchPicture(StudyCell& cell) {
  cell.steps.push_back({"preview stretch",
                        {"preview", "rigged.glb", "--show", "stretch", "--worst", std::string(kPoses), "--deformer",
                         cell.deformer, "--size", std::string(kPoseSize), "--quiet", "-o", "stretch.png"},
                        MeasureSource::kNone,
                        {},
                        "stretch",
                        false,
                        true});
}

void addPictures(StudyCell& cell) {
  for (const std::string_view what : {"bones", "weights"}) {
    cell.steps.push_back({fmt::format("preview {}", what),
                          {"preview", "rigged.glb", "--show", std::string(what), "--rest", "--size",
                           std::string(kPictureSize), "--quiet", "-o", fmt::format("{}.png", what)},
                          MeasureSource::kNone,
                          {},
                          std::string(what)});
  }
}

// Whether there is a combination before it with the same rig and another deformer.
bool hasRigOfEarlier(std::span<const RigCombination> combinations, std::size_t index) {
  const RigCombination& one = combinations[index];
  return std::any_of(combinations.begin(), combinations.begin() + static_cast<std::ptrdiff_t>(index),
                     [&](const RigCombination& earlier) {
                       return earlier.rigger == one.rigger && earlier.skinning == one.skinning &&
                              earlier.setting.name == one.setting.name && earlier.deformer != one.deformer;
                     });
}

void addAdapters(std::span<const std::filesystem::path> adapters, std::vector<std::string>& arguments,
                 StudyCell& cell) {
  for (const std::filesystem::path& adapter : adapters) {
    arguments.insert(arguments.end(), {"--adapter", adapter.string()});
    cell.inputs.push_back(adapter);
  }
}

// measuresRig  else what depends on the deformer alone
StudyCell rigCell(const StudyModel& model, const RigCombination& combination, const std::string& threads,
                  bool measuresRig) {
  const std::string file = model.input.file.string();
  const bool keepsSkeleton = combination.rigger == kOwnSkeleton;
  StudyCell cell;
  cell.kind = CellKind::kRig;
  cell.group = model.input.group;
  cell.model = model.input.name;
  cell.rigger = combination.rigger;
  cell.skinning = combination.skinning;
  cell.options = combination.setting.name;
  cell.deformer = combination.deformer;
  cell.inputs = {model.input.file};
  std::vector<std::string> rig = {"rig", file};
  if (keepsSkeleton) {
    rig.emplace_back("--keep-skeleton");
  } else {
    rig.insert(rig.end(), {"--rigger", combination.rigger});
    if (model.isRigged) rig.emplace_back("--replace-rig");
  }
  rig.insert(rig.end(), {"--skinning", combination.skinning});
  addAdapters(combination.adapters, rig, cell);
  rig.insert(rig.end(), combination.setting.arguments.begin(), combination.setting.arguments.end());
  rig.insert(rig.end(), {"--threads", threads, "--quiet", "-o", "rigged.glb", "--json", "report.json"});
  cell.steps.push_back({"rig", std::move(rig), MeasureSource::kRigReport, "report.json", {}, measuresRig});
  if (model.isRigged && measuresRig) {
    const std::string what = keepsSkeleton ? "weights" : "rig";
    cell.steps.push_back({"evaluate " + what,
                          {"evaluate", what, "rigged.glb", file, "--json"},
                          keepsSkeleton ? MeasureSource::kWeightTruth : MeasureSource::kSkeletonTruth});
  }
  CellStep evaluation = {"evaluate model",
                         {"evaluate", "model", "rigged.glb", "--json"},
                         measuresRig ? MeasureSource::kModel : MeasureSource::kModelMotion};
  if (!cell.deformer.empty()) {
    evaluation.arguments.insert(evaluation.arguments.end(), {"--deformer", cell.deformer});
  }
  cell.steps.push_back(std::move(evaluation));
  if (measuresRig) addPictures(cell);
  if (!cell.deformer.empty()) addStretchPicture(cell);
  return cell;
}

StudyCell retargetCell(const StudyInput& character, const StudyInput& motion, const RetargetCombination& combination,
                       const std::string& threads) {
  StudyCell cell;
  cell.kind = CellKind::kRetarget;
  cell.group = character.group;
  cell.model = character.name;
  cell.motion = motion.name;
  cell.retargeting = combination.method;
  cell.solver = combination.solver;
  cell.inputs = {character.file, motion.file};
  std::vector<std::string> retarget = {"retarget", character.file.string(), motion.file.string(), "--method",
                                       combination.method};
  if (!combination.solver.empty()) retarget.insert(retarget.end(), {"--solver", combination.solver});
  addAdapters(combination.adapters, retarget, cell);
  retarget.insert(retarget.end(), {"--threads", threads, "--quiet", "-o", "moving.glb"});
  cell.steps.push_back({"retarget", std::move(retarget), MeasureSource::kNone, {}, {}, true});
  cell.steps.push_back({"evaluate motion",
                        {"evaluate", "motion", "moving.glb", "--source", motion.file.string(), "--json"},
                        MeasureSource::kMotion});
  cell.steps.push_back(
      {"convert", {"convert", "moving.glb", "--trim", std::string(kShown), "--quiet", "-o", "shown.glb"}});
  cell.steps.push_back({"preview motion",
                        {"preview", "shown.glb", "--clip", motion.file.stem().string(), "--animate", "--fps",
                         std::string(kMovingFps), "--size", std::string(kMovingSize), "--quiet", "-o", "motion.png"},
                        MeasureSource::kNone,
                        {},
                        "motion"});
  return cell;
}

}  // namespace

std::string_view cellKindName(CellKind kind) {
  return kind == CellKind::kRig ? "rig" : "retarget";
}

std::string StudyCell::subject() const {
  return motion.empty() ? model : model + ", " + motion;
}

std::string StudyCell::method() const {
  std::string text = kind == CellKind::kRig ? rigger + " + " + skinning : retargeting;
  if (!deformer.empty()) text += " + " + deformer;
  if (!solver.empty()) text += " + " + solver;
  if (!options.empty()) text += ", " + options;
  return text;
}

std::vector<StudyCell> rigCells(const StudyPlan& plan, std::span<const StudyModel> models) {
  std::vector<StudyCell> cells;
  for (const StudyModel& model : models) {
    for (std::size_t i = 0; i < plan.rig.combinations.size(); ++i) {
      const RigCombination& combination = plan.rig.combinations[i];
      if (combination.rigger == kOwnSkeleton && !model.isRigged) continue;
      const bool measuresRig = !hasRigOfEarlier(plan.rig.combinations, i);
      cells.push_back(rigCell(model, combination, std::to_string(plan.threads), measuresRig));
    }
  }
  return cells;
}

std::vector<StudyCell> retargetCells(const StudyPlan& plan, std::span<const StudyInput> characters,
                                     std::span<const StudyInput> motions) {
  std::vector<StudyCell> cells;
  for (const StudyInput& character : characters) {
    for (const StudyInput& motion : motions) {
      for (const RetargetCombination& combination : plan.retarget.combinations) {
        cells.push_back(retargetCell(character, motion, combination, std::to_string(plan.threads)));
      }
    }
  }
  return cells;
}

std::optional<double> CellResult::valueOf(const Measure& measure) const {
  for (const MeasuredValue& one : measures) {
    if (one.measure == &measure) return one.value;
  }
  return std::nullopt;
}

std::string commandText(const CellStep& step) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=:,+";
  std::string text = "limber";
  for (const std::string& argument : step.arguments) {
    if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) {
      text += " " + argument;
      continue;
    }
    text += " '";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += "'";
  }
  return text;
}

}  // namespace limber
