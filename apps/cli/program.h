// The program's commands as a call.
#pragma once

#include <string>
#include <vector>

namespace limber::cli {

// The exit code of a command that was kept from writing by a StorageError.
inline constexpr int kStorageCode = 4;

// Who calls. In a batch an entry's options come behind the command's: of an option that takes one value the last
// counts, but of --output, which is the batch's to give; and help is no work done.
enum class Caller { kUser, kBatch };

// What main does: parses the arguments, without the program's name, runs the command, and says what went wrong on
// standard error. Returns the exit code.
int runProgram(const std::vector<std::string>& arguments, Caller caller = Caller::kUser);

// What can be told of a call without running it.
struct CallOutline {
  std::string problem;                         // why it makes no sense, empty where that cannot be told
  bool hasOutput = false, hasThreads = false;  // does the command have --output, --threads?
};
CallOutline outlineCall(const std::vector<std::string>& arguments, Caller caller);

}  // namespace limber::cli
