// What a batch does to its files, as digests: they tell whether a record is of the plan as it is now.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/batch/batch_plan.h"
#include "limber/core/error.h"
#include "limber/study/input_digest.h"

namespace limber {

struct BatchTask {
  // Of the program, the command, the entry's options and the bytes of the files that these name; not of its input.
  std::string digest;            // 16 hexadecimal digits
  std::optional<Error> problem;  // of a file that is named and cannot be read
};

// The tasks of a plan's entries. Files that they name are read once.
class BatchTasks {
 public:
  // The plan must outlive this. Words of its command that are names of adapters in the folders name these files. Throws
  // Error kFile where the program cannot be read.
  BatchTasks(const BatchPlan& plan, const std::filesystem::path& program,
             std::vector<std::filesystem::path> adapterFolders = {});

  BatchTask of(const BatchEntry& entry);

 private:
  BatchTask taskWith(const std::vector<std::string>& options);
  const BatchTask& fileOf(const std::string& argument);
  std::filesystem::path fileNamed(const std::string& name) const;

  const BatchPlan& plan_;
  std::vector<std::filesystem::path> adapterFolders_;
  std::string program_;  // its digest
  InputDigests inputs_;
  std::map<std::string, BatchTask> files_;  // that arguments name, by argument; an empty digest: it names none
  BatchTask common_;                        // of entries without options
};

// What the latest run of a batch was to do: its folder's plan.json.
struct PlannedOutputs {
  std::vector<std::string> outputs;           // in the order of the plan
  std::string task;                           // the digest of most; empty in a folder of an earlier version
  std::map<std::size_t, std::string> others;  // those of entries that differ, by their index in the order

  const std::string& taskOf(std::size_t index) const;
};

PlannedOutputs plannedOutputs(const BatchPlan& plan, BatchTasks& tasks);

// {"limber_batch": 1, "task": "...", "outputs": [...], "tasks": [[3, "..."], ...]}, the last of those that differ.
std::string plannedOutputsText(const PlannedOutputs& planned);
// Throws Error kBadData where the text is no such thing.
PlannedOutputs parsePlannedOutputs(std::string_view text);

}  // namespace limber
