// The program's commands as a call.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limber::cli {

// The exit code of a command that was kept from writing by a StorageError.
inline constexpr int kStorageCode = 4;

// A call in a batch, whose plan may be a stranger's. An entry's options come behind the command's: of an option that
// takes one value the last counts. Help is no work done. Options that are not for plans (notForPlans) are refused.
struct BatchCall {
  std::string output;                                      // the only value that --output may have
  std::vector<std::filesystem::path> adapterFolders = {};  // those that --adapter-folder may name
};

// What main does: parses the arguments, without the program's name, runs the command, and says what went wrong on
// standard error. Returns the exit code.
int runProgram(const std::vector<std::string>& arguments, const BatchCall* batch = nullptr);

// What can be told of a call without running it.
struct CallOutline {
  std::string problem;  // why it makes no sense, empty where that cannot be told
  // Does the command have --output, --threads, --adapter-folder?
  bool hasOutput = false, hasThreads = false, hasAdapters = false;
};
CallOutline outlineCall(const std::vector<std::string>& arguments, const BatchCall& batch);

}  // namespace limber::cli
