#include "limber/study/study_run.h"

#include <algorithm>
#include <map>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/core/file/folder.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/utf8.h"
#include "limber/jobs/job_key.h"
#include "limber/jobs/job_pool.h"
#include "limber/jobs/result_store.h"
#include "limber/study/command_words.h"
#include "limber/study/input_digest.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

// kWork is also what a study's folder is known by.
constexpr const char *kCells = "cells", *kPictures = "pictures", *kWork = ".limber-study", *kSamples = "samples";

// Files by their names alone, so that tables do not depend on where a study runs.
std::string withoutFolders(std::string text, std::span<const fs::path> inputs) {
  for (const fs::path& input : inputs) {
    text = replaced(std::move(text), validUtf8(input.string()), validUtf8(input.filename().string()));
  }
  return text;
}

Json parsed(std::string_view text) {
  Warnings ignored;
  return parseJson(text, ignored);
}

Json keptJson(const CellResult& result, const JobLimits& limits) {
  Json measures = Json::object(), pictures = Json::array();
  for (const MeasuredValue& one : result.measures) measures[std::string(one.measure->name)] = one.value;
  for (const CellPicture& picture : result.pictures) pictures.push_back(picture.name);
  return {{"limber_cell", 1},
          {"outcome", jobOutcomeName(result.outcome)},
          {"problem", result.problem},
          {"limits", {{"seconds", limits.seconds}, {"memory", limits.memory}}},
          {"measures", std::move(measures)},
          {"pictures", std::move(pictures)}};
}

// Seen from the study's folder.
fs::path picturePath(const std::string& key, const std::string& name) {
  return fs::path(kPictures) / fmt::format("{}-{}.png", key, name);
}

struct KeptCell {
  CellResult result;
  JobLimits limits;  // that it ran within
};

// Throws Error where the text is not what keptJson gives.
KeptCell keptCellOf(std::string_view text, const StudyCell& cell, const std::string& key) {
  const Json json = parsed(text);
  const JsonView root(json);
  KeptCell kept;
  if (root.count("limber_cell") != 1) root.fail("is of another version");
  kept.result.outcome = findJobOutcome(root.text("outcome"));
  kept.result.problem = root.text("problem");
  kept.limits.seconds = root.object("limits").number("seconds", 0);
  kept.limits.memory = root.object("limits").count("memory").value_or(0);
  root.object("measures").forEachMember([&](std::string_view name, const JsonView& value) {
    kept.result.measures.push_back({&findMeasure(name), value.asNumber()});
  });
  const JsonView pictures = root.array("pictures");
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Json& name = pictures[i].json();
    const auto isMade = [&](const CellStep& step) { return !step.picture.empty() && name == step.picture; };
    const auto step = std::find_if(cell.steps.begin(), cell.steps.end(), isMade);
    if (step == cell.steps.end()) pictures[i].fail("is no picture of the cell");
    kept.result.pictures.push_back({step->picture, picturePath(key, step->picture)});
  }
  return kept;
}

// The study while it runs.
class StudyRun {
 public:
  StudyRun(const StudyPlan& plan, const StudyOptions& options, Progress& progress)
      : plan_(plan),
        options_(options),
        output_(fs::absolute(options.output).lexically_normal()),
        progress_(progress),
        store_(prepared(output_) / kCells) {
    removeFolder(output_ / kWork);
    for (const char* folder : {kWork, kPictures, kSamples}) makeFolder(output_ / folder);
    program_ = sha256OfFile(options.program);
  }

  StudyResult run() {
    StudyResult study;
    study.title = plan_.title;
    const std::vector<StudyInput> models = find(plan_.rig.models, InputKind::kModel),
                                  characters = find(plan_.retarget.characters, InputKind::kModel),
                                  motions = find(plan_.retarget.motions, InputKind::kMotion);
    progress_.stage("make samples");
    makeSamples({&models, &characters, &motions});
    progress_.stage("read models");
    study.cells = rigCells(plan_, readModels(models));
    for (StudyCell& cell : retargetCells(plan_, characters, motions)) study.cells.push_back(std::move(cell));
    progress_.stage("run cells");
    runCells(study);
    return study;
  }

 private:
  // The study's folder, marked as such before anything else is in it. One with other files, in which a study would
  // replace and remove some, is refused.
  static const fs::path& prepared(const fs::path& output) {
    std::error_code unseen;
    const bool isFree =
        !fs::exists(output, unseen) || fs::is_empty(output, unseen) || fs::is_directory(output / kWork, unseen);
    if (!isFree) {
      throw Error(ErrorCode::kFile, "holds other files than a study's", output.string(),
                  "name a folder that is empty or new");
    }
    makeFolder(output / kWork);
    return output;
  }

  std::vector<StudyInput> find(const std::vector<std::string>& names, InputKind kind) const {
    return findInputs(names, kind, options_.planFolder, output_ / kSamples);
  }

  Job jobOf(const std::vector<std::string>& arguments, const fs::path& folder) const {
    Job job;
    job.command = {options_.program.string()};
    job.command.insert(job.command.end(), arguments.begin(), arguments.end());
    job.folder = folder;
    job.limits = plan_.limits;
    if (options_.outOfMemoryCode != 0) job.outOfMemoryCode = options_.outOfMemoryCode;
    return job;
  }

  void makeSamples(std::initializer_list<const std::vector<StudyInput>*> lists) {
    std::vector<JobChain> chains;
    std::vector<std::string> names;
    for (const std::vector<StudyInput>* inputs : lists) {
      for (const StudyInput& input : *inputs) {
        const std::string file = input.file.string();
        if (input.sample.empty() || std::find(names.begin(), names.end(), file) != names.end()) continue;
        names.push_back(file);
        chains.push_back({jobOf({"sample", input.sample, "-o", file, "--quiet"}, output_)});
      }
    }
    runJobs(chains, options_.jobs, progress_, [&](std::size_t i, const std::vector<JobResult>& results) {
      if (results.back().outcome == JobOutcome::kDone) return;
      const std::string words = commandWords(results.back().error);
      throw Error(ErrorCode::kFile, words.empty() ? jobOutcomeText(chains[i].front(), results.back()) : words,
                  names[i]);
    });
  }

  const std::string& digestOf(const fs::path& file) {
    std::string& digest = digests_[file.string()];
    if (digest.empty()) digest = inputs_.of(file).all;
    return digest;
  }

  // Which models have a truth to compare with; those that cannot be read have none.
  std::vector<StudyModel> readModels(const std::vector<StudyInput>& inputs) {
    std::vector<StudyModel> models;
    std::vector<JobChain> chains;
    std::vector<std::pair<std::size_t, std::string>> open;  // model, key
    for (const StudyInput& input : inputs) {
      models.push_back({input});
      const std::string key = JobKey().add("limber study model 1").add(program_).add(digestOf(input.file)).hex();
      if (const std::optional<std::string> kept = store_.find(key)) {
        models.back().isRigged = *kept == "true";
        continue;
      }
      open.push_back({models.size() - 1, key});
      chains.push_back({jobOf({"info", input.file.string(), "--json"}, output_)});
    }
    runJobs(chains, options_.jobs, progress_, [&](std::size_t i, const std::vector<JobResult>& results) {
      const JobResult& result = results.back();
      const auto& [model, key] = open[i];
      models[model].isRigged = result.outcome == JobOutcome::kDone && hasWeights(result.out);
      const bool isSettled = result.outcome == JobOutcome::kDone || result.outcome == JobOutcome::kFailed;
      if (isSettled) store_.keep(key, models[model].isRigged ? "true" : "false");
    });
    return models;
  }

  static bool hasWeights(const std::string& info) {
    try {
      const Json json = parsed(info);
      return json.contains("weights") && json["weights"].is_object();
    } catch (const Error&) {
      return false;
    }
  }

  std::string keyOf(const StudyCell& cell) {
    JobKey key;
    key.add("limber study cell 1").add(program_);
    for (const CellStep& step : cell.steps) {
      key.add(step.name);
      for (const std::string& argument : step.arguments) {
        const bool isInput = std::find(cell.inputs.begin(), cell.inputs.end(), argument) != cell.inputs.end();
        key.add(isInput ? digestOf(argument) : argument);
      }
    }
    return key.hex();
  }

  // None where it has to run.
  std::optional<CellResult> keptCell(const StudyCell& cell, const std::string& key) const {
    const std::optional<std::string> text = store_.find(key);
    if (!text) return std::nullopt;
    try {
      KeptCell kept = keptCellOf(*text, cell, key);
      const JobOutcome outcome = kept.result.outcome;
      const bool hasMore = (outcome == JobOutcome::kTimedOut && plan_.limits.seconds > kept.limits.seconds) ||
                           (outcome == JobOutcome::kOutOfMemory && plan_.limits.memory > kept.limits.memory);
      if (hasMore || (options_.retries && outcome != JobOutcome::kDone)) return std::nullopt;
      for (const CellPicture& picture : kept.result.pictures) {
        std::error_code unseen;
        if (!fs::is_regular_file(output_ / picture.file, unseen)) return std::nullopt;
      }
      return std::move(kept.result);
    } catch (const Error&) {  // of another version, or not whole
      return std::nullopt;
    }
  }

  void runCells(StudyResult& study) {
    study.results.resize(study.cells.size());
    std::map<std::string, std::vector<std::size_t>> cellsOf;  // by key: alike cells run once
    std::vector<std::string> open;                            // keys, in the order of the cells
    for (std::size_t i = 0; i < study.cells.size(); ++i) {
      const std::string key = keyOf(study.cells[i]);
      std::vector<std::size_t>& cells = cellsOf[key];
      cells.push_back(i);
      if (std::optional<CellResult> kept = keptCell(study.cells[i], key)) {
        study.results[i] = std::move(*kept);
      } else if (cells.size() == 1) {
        open.push_back(key);
      }
    }
    std::vector<JobChain> chains;
    for (const std::string& key : open) {
      makeFolder(output_ / kWork / key);
      chains.emplace_back();
      for (const CellStep& step : study.cells[cellsOf[key].front()].steps) {
        chains.back().push_back(jobOf(step.arguments, output_ / kWork / key));
      }
    }
    std::size_t left = 0;
    for (const std::string& key : open) left += cellsOf[key].size();
    const double begun = secondsNow();
    tell(study, left, begun);
    runJobs(chains, options_.jobs, progress_, [&](std::size_t i, const std::vector<JobResult>& results) {
      const std::vector<std::size_t>& cells = cellsOf[open[i]];
      const CellResult result = takeCell(study.cells[cells.front()], open[i], chains[i], results);
      store_.keep(open[i], dumpReport(keptJson(result, plan_.limits)));
      for (const std::size_t cell : cells) study.results[cell] = result;
      study.ran += cells.size();
      removeFolder(output_ / kWork / open[i]);
      left -= cells.size();
      tell(study, left, begun);
    });
  }

  void tell(const StudyResult& study, std::size_t left, double begun) const {
    if (!options_.tell) return;
    StudyProgress at{study.cells.size(), study.cells.size() - left, 0};
    const auto ran = static_cast<double>(study.ran);
    if (study.ran > 0) at.secondsLeft = (secondsNow() - begun) / ran * static_cast<double>(left);
    options_.tell(at);
  }

  // Whether the model has a part that bends.
  static bool hasMotion(const CellResult& result) {
    return std::any_of(result.measures.begin(), result.measures.end(),
                       [](const MeasuredValue& one) { return one.measure->source == MeasureSource::kModelMotion; });
  }

  // The outputs of a cell's commands: measures, and pictures, which are moved to their final paths.
  CellResult takeCell(const StudyCell& cell, const std::string& key, const JobChain& jobs,
                      const std::vector<JobResult>& results) const {
    CellResult taken;
    for (std::size_t s = 0; s < results.size(); ++s) {
      const CellStep& step = cell.steps[s];
      const JobResult& result = results[s];
      const bool mayRefuse = step.needsMotion && !hasMotion(taken);
      if (mayRefuse && result.outcome == JobOutcome::kFailed) break;
      if (result.outcome != JobOutcome::kDone) {
        taken.outcome = result.outcome;
        taken.problem = fmt::format("{}: {}", step.name, jobOutcomeText(jobs[s], result));
        const std::string words = withoutFolders(commandWords(result.error), cell.inputs);
        if (!words.empty()) taken.problem += ": " + words;
        break;
      }
      try {
        takeStep(step, result, key, taken);
      } catch (const Error& error) {
        taken.outcome = JobOutcome::kFailed;
        taken.problem = fmt::format("{}: {}", step.name, error.what());
        break;
      }
    }
    return taken;
  }

  void takeStep(const CellStep& step, const JobResult& result, const std::string& key, CellResult& taken) const {
    const fs::path folder = output_ / kWork / key;
    if (step.measures != MeasureSource::kNone) {
      std::string text = result.out;
      if (!step.report.empty()) {
        const Bytes bytes = readFile(folder / step.report);
        text.assign(bytes.begin(), bytes.end());
      }
      for (const MeasuredValue& value : measuresIn(parsed(text), step.measures)) taken.measures.push_back(value);
    }
    if (step.isTimed) taken.measures.push_back({&findMeasure("seconds"), result.seconds});
    if (!step.picture.empty()) {
      const fs::path location = picturePath(key, step.picture);
      std::error_code problem;
      fs::rename(folder / (step.picture + ".png"), output_ / location, problem);
      if (problem) throw Error(ErrorCode::kFile, "cannot be written: " + problem.message(), location.string());
      taken.pictures.push_back({step.picture, location});
    }
  }

  const StudyPlan& plan_;
  const StudyOptions& options_;
  fs::path output_;
  Progress& progress_;
  ResultStore store_;
  std::string program_;  // its digest
  InputDigests inputs_;
  std::map<std::string, std::string> digests_;  // of inputs, by path
};

}  // namespace

StudyResult runStudy(const StudyPlan& plan, const StudyOptions& options, Progress& progress) {
  return StudyRun(plan, options, progress).run();
}

}  // namespace limber
