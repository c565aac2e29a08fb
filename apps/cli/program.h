// The program's commands as a call.
#pragma once

#include <string>
#include <vector>

namespace limber::cli {

// The exit code of a command that was kept from writing by a StorageError.
inline constexpr int kStorageCode = 4;

// Of an option that takes one value and is given more than once.
enum class RepeatedOption { kIsRefused, kLastCounts };

// What main does: parses the arguments, without the program's name, runs the command, and says what went wrong on
// standard error. Returns the exit code.
int runProgram(const std::vector<std::string>& arguments, RepeatedOption repeated = RepeatedOption::kIsRefused);

// What can be told of a call without running it.
struct CallOutline {
  std::string problem;                         // why it makes no sense, empty where that cannot be told
  bool hasOutput = false, hasThreads = false;  // does the command have --output, --threads?
};
CallOutline outlineCall(const std::vector<std::string>& arguments, RepeatedOption repeated);

}  // namespace limber::cli
