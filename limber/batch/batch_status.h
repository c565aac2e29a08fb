// The status of a batch, from the records of all its shards.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "limber/core/error.h"
#include "limber/jobs/job.h"

namespace limber {

// Entries that failed alike.
struct BatchFailures {
  JobOutcome outcome = JobOutcome::kFailed;
  std::string problem;
  std::size_t count = 0;
  std::string example;  // an input
};

struct BatchStatus {
  std::size_t entries = 0, done = 0, failed = 0;
  std::size_t lost = 0;                 // done, but their outputs are no longer there
  std::size_t outdated = 0;             // recorded, but of another command, options or program than the latest run's
  double seconds = 0, slowest = 0;      // of all that ran, and of one
  std::size_t peakMemory = 0;           // bytes, of one
  std::vector<BatchFailures> failures;  // the most frequent first
  std::vector<std::pair<std::string, std::size_t>> warnings;  // kinds, and how many entries have each; likewise
  std::vector<std::string> leftOver;  // outputs of earlier plans that the latest does not name, still there; by name
  Warnings recordWarnings;            // of reading the records

  std::size_t open() const { return entries - done - failed; }  // not run yet, lost or outdated
  bool isWell() const { return done == entries; }
};

// By the plan of the latest run, whichever its shard. Inputs are not looked at: whether these have changed, a run alone
// tells. In a folder of an earlier version, whose plan.json names no task, records of any command count.
//
// Cost: O(n log n) in the number of records; outputs are looked for, not opened. Throws Error kFile: the folder is no
// batch's; and as readBatchRecords does.
BatchStatus batchStatus(const std::filesystem::path& output);

// The last record of each entry of the plan, a line each, in its order: the batch's table as one file. Those that are
// outdated are left out.
std::string mergedBatchRecords(const std::filesystem::path& output);

}  // namespace limber
