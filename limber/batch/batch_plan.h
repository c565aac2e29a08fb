// What a batch is to do: one command, and the files that it is done to.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/jobs/job.h"

namespace limber {

// Placeholders in a command for the input file of an entry, and for its output.
inline constexpr std::string_view kBatchInput = "{input}", kBatchOutput = "{output}";
// In a batch's folder of outputs: all that is no output.
inline constexpr std::string_view kBatchOwnFolder = ".limber-batch";

struct BatchEntry {
  std::string input;                 // as the plan names it, seen from the plan's folder
  std::string output;                // seen from the folder of outputs, '/' between its parts; unlike all others
  std::string sha256;                // that the input's bytes must have; empty: any
  std::vector<std::string> options;  // behind those of the command
};

struct BatchPlan {
  std::filesystem::path folder;      // that inputs, and other files that the command names, are seen from; absolute
  std::vector<std::string> command;  // "rig", "{input}", "-o", "{output}", ...: the input once, the output at most once
  JobLimits limits;                  // of each entry
  std::vector<BatchEntry> entries;   // in the order of the plan, files of a folder by their paths
};

// A part of a batch: every `count`th entry, beginning with the `number`th.
struct BatchShard {
  std::size_t number = 1, count = 1;  // 1 <= number <= count
};
// "3/16". Throws Error kBadArgument.
BatchShard parseBatchShard(std::string_view text);

// A plan in JSON (docs/batch.schema.json), with what its inputs name looked up: folders with everything in them that
// limber reads, at any depth; patterns, in which * and ? stand for what is within a name and ** for folders; lists of
// paths (.txt: one a line; .jsonl: {"path", "sha256", "options"}; read by listLines); files. An output is called as its
// input, seen from the plan's folder, with the plan's extension; inputs that would be called alike keep theirs
// ("a_obj.glb", "a_stl.glb"). What folders and patterns find below `outputs`, the batch's folder of outputs, is left
// out: the same plan has the same entries once it has run.
//
// `commands` are those that a batch may run. Throws Error kBadData that names the wrong entry, also where an output
// would have to be a file and the folder of another, or would lie in the batch's own folder; kFile where an input is
// not there (of lists, only the list is looked for). Cost: O(n log n) in the number of entries; no input is opened.
BatchPlan readBatchPlan(const std::filesystem::path& file, std::span<const std::string_view> commands,
                        const std::filesystem::path& outputs = {});

// A plan that runs as it is, in a folder with models.
std::string exampleBatchPlan();

}  // namespace limber
