#include "limber/batch/batch_task.h"

#include <new>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/jobs/job_key.h"
#include "limber/jobs/sha256.h"

namespace limber {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kTaskDigits = 16;

std::string textIn(const JsonView& value) {
  if (!value.json().is_string()) value.fail("is not a text");
  return value.json().get<std::string>();
}

}  // namespace

BatchTasks::BatchTasks(const BatchPlan& plan, const fs::path& program, std::vector<fs::path> adapterFolders)
    : plan_(plan),
      adapterFolders_(std::move(adapterFolders)),
      program_(sha256OfFile(program)),
      inputs_(plan.limits.memory) {
  common_ = taskWith({});
}

BatchTask BatchTasks::of(const BatchEntry& entry) {
  return entry.options.empty() ? common_ : taskWith(entry.options);
}

BatchTask BatchTasks::taskWith(const std::vector<std::string>& options) {
  BatchTask task;
  JobKey key;
  key.add("limber batch task 1").add(program_);
  const auto add = [&](const std::string& argument) {
    const BatchTask& file = fileOf(argument);
    key.add(argument).add(file.digest);
    if (!task.problem) task.problem = file.problem;
  };
  for (const std::string& argument : plan_.command) add(argument);
  key.add("options");
  for (const std::string& option : options) add(option);
  task.digest = key.hex().substr(0, kTaskDigits);
  return task;
}

// A file beside the plan, else an adapter; empty where there is neither.
fs::path BatchTasks::fileNamed(const std::string& name) const {
  std::error_code unseen;
  if (name.empty()) return {};
  if (fs::path file = plan_.folder / name; fs::is_regular_file(file, unseen)) return file;
  for (const fs::path& folder : adapterFolders_) {
    if (fs::path file = folder / (name + ".json"); fs::is_regular_file(file, unseen)) return file;
  }
  return {};
}

// The file that the argument names, by itself or as --name=file.
const BatchTask& BatchTasks::fileOf(const std::string& argument) {
  const auto [known, isNew] = files_.try_emplace(argument);
  BatchTask& file = known->second;
  if (!isNew) return file;
  const std::size_t equals = argument.starts_with("--") ? argument.find('=') : std::string::npos;
  const std::string name = equals == std::string::npos ? argument : argument.substr(equals + 1);
  const fs::path named = fileNamed(name);
  if (named.empty()) return file;
  try {
    file.digest = inputs_.of(named).all;
  } catch (const Error& error) {
    file.problem = error;
  } catch (const std::bad_alloc&) {
    file.problem = Error(ErrorCode::kLimit, "takes more memory to be looked at than there is", name);
  }
  if (file.problem) file.digest = file.problem->what();
  return file;
}

const std::string& PlannedOutputs::taskOf(std::size_t index) const {
  const auto other = others.find(index);
  return other == others.end() ? task : other->second;
}

PlannedOutputs plannedOutputs(const BatchPlan& plan, BatchTasks& tasks) {
  PlannedOutputs planned;
  planned.task = tasks.of({}).digest;
  for (const BatchEntry& entry : plan.entries) {
    std::string task = tasks.of(entry).digest;
    if (task != planned.task) planned.others.emplace(planned.outputs.size(), std::move(task));
    planned.outputs.push_back(entry.output);
  }
  return planned;
}

std::string plannedOutputsText(const PlannedOutputs& planned) {
  Json outputs = Json::array(), tasks = Json::array();
  for (const std::string& output : planned.outputs) outputs.push_back(output);
  for (const auto& [index, task] : planned.others) tasks.push_back(Json::array({index, task}));
  Json json = {{"limber_batch", 1}, {"task", planned.task}, {"outputs", std::move(outputs)}};
  if (!tasks.empty()) json["tasks"] = std::move(tasks);
  return dumpReport(json, 0) + "\n";
}

PlannedOutputs parsePlannedOutputs(std::string_view text) {
  Warnings ignored;
  const Json json = parseJson(text, ignored);
  const JsonView root(json);
  if (root.count("limber_batch") != 1) root.fail("is of another version");
  PlannedOutputs planned;
  planned.task = root.text("task");
  const JsonView outputs = root.array("outputs"), tasks = root.array("tasks");
  planned.outputs.reserve(outputs.size());
  for (std::size_t i = 0; i < outputs.size(); ++i) planned.outputs.push_back(textIn(outputs[i]));
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].size() != 2) tasks[i].fail("is no place and task");
    planned.others.emplace(tasks[i][0].asIndex(outputs.size()), textIn(tasks[i][1]));
  }
  return planned;
}

}  // namespace limber
