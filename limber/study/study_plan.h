// What a study runs over: models, methods and settings; docs/study.schema.json describes the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limber/jobs/job.h"

namespace limber {

// Used like the name of a rigger, for each model's own skeleton with weights made anew.
inline constexpr std::string_view kOwnSkeleton = "own";
// Prefix of the name of one of the program's samples, instead of a file: "sample:quadruped".
inline constexpr std::string_view kSamplePrefix = "sample:";

// Options of `limber rig` under a name.
struct RigSetting {
  std::string name;                    // empty: the usual ones
  std::vector<std::string> arguments;  // of the program
};

struct RigCombination {
  std::string rigger, skinning;
  RigSetting setting;
  std::vector<std::filesystem::path> adapters = {};  // files of the programs of the user's among these
  std::string deformer = {};                         // empty: the plan names none; linear blending
};

// models         files, folders and samples, as the plan has them
// combinations   each is tried on each model
struct RigPlan {
  std::vector<std::string> models;
  std::vector<RigCombination> combinations;
};

struct RetargetCombination {
  std::string method, solver;                        // solver: empty where the method uses none
  std::vector<std::filesystem::path> adapters = {};  // the file of a program of the user's
};

// Each combination is tried on each pair of a character and a motion.
struct RetargetPlan {
  std::vector<std::string> characters, motions;
  std::vector<RetargetCombination> combinations;
};

struct StudyPlan {
  std::string title = "Study";
  RigPlan rig;            // without models where the plan has none
  RetargetPlan retarget;  // without characters likewise
  JobLimits limits;       // of each command
  int threads = 1;        // of each command
};

// Lists of methods are multiplied out, in the order of the plan; "all" stands for all of limber's own. A rigger,
// skinning or retargeting method that is none of these is an adapter (findAdapter) in `adapterFolders`. Throws Error
// kBadData that names the entry: not JSON, another version, a key or a method that is not known, options of `limber
// rig` that do not go with a rigger, nothing to run; and as findAdapter.
StudyPlan studyPlanFromJson(std::string_view text, const std::vector<std::filesystem::path>& adapterFolders = {});

// A plan of samples that runs as it is.
std::string exampleStudyPlan();

}  // namespace limber
