// A command that runs as a process of its own, and how it ended.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limber {

// Time counts for all that the job starts; it is ended with it. Memory counts for each process for itself, and a job
// may give one that it starts another limit: for programs of the user's, an adapter tells it.
struct JobLimits {
  double seconds = 600;                          // on the clock, above 0
  std::size_t memory = std::size_t{4096} << 20;  // bytes of memory of its own (RLIMIT_DATA; RLIMIT_AS off Linux)
};

struct Job {
  std::vector<std::string> command;  // the program's path, then its arguments; no shell reads them
  // If set, this runs instead of `command`, in a child of this process, where everything loaded and made here is ready.
  // Returns the exit code. This process must then have no other threads, or none that hold a lock.
  std::function<int()> work;
  std::filesystem::path folder;  // that it works in
  JobLimits limits;
  std::optional<int> outOfMemoryCode;            // by which the program says that memory did not suffice
  std::size_t maxOutput = std::size_t{1} << 20;  // bytes kept of each stream: the last
};

enum class JobOutcome {
  kDone,         // exit code 0
  kFailed,       // another exit code
  kCrashed,      // ended by a signal that did not come from here
  kTimedOut,     // ended here, with all processes of its group
  kOutOfMemory,  // said so by its exit code
  kNotStarted,   // the program could not be run
};

// Stable and short: "done", "failed", "crashed", "timed-out", "out-of-memory", "not-started".
std::string_view jobOutcomeName(JobOutcome outcome);
// Throws Error kBadArgument that lists the names there are.
JobOutcome findJobOutcome(std::string_view name);

struct JobResult {
  JobOutcome outcome = JobOutcome::kNotStarted;
  int code = 0;                // the exit code, the signal, or why it did not start (errno)
  double seconds = 0;          // on the clock
  std::size_t peakMemory = 0;  // bytes resident at most
  std::string out, error;      // the last bytes of standard output and standard error
};

// "exit code 1", "signal 11", "more than 60 s", ...; empty for what is done.
std::string jobOutcomeText(const Job& job, const JobResult& result);

}  // namespace limber
