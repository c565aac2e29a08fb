// Runs many jobs, several at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/jobs/job.h"

namespace limber {

// Jobs of which each begins when the one before is done. The first that ends otherwise is the last that ran.
using JobChain = std::vector<Job>;

// Is given the number of a chain and the results of the jobs that ran, in order.
using ChainDone = std::function<void(std::size_t chain, const std::vector<JobResult>& results)>;

// Runs the chains, `atOnce` (1 or more) side by side and begun in order; `done` is called in this thread as each ends.
// Throws Error kCancelled as Progress does, and what `done` throws; whatever leaves ends all processes that still run.
void runJobs(std::span<const JobChain> chains, int atOnce, Progress& progress, const ChainDone& done);

}  // namespace limber
