// Runs many jobs, several at a time.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "limber/core/progress.h"
#include "limber/jobs/job.h"

namespace limber {

// Jobs of which each begins when the one before is done. The first that ends otherwise is the last that ran.
using JobChain = std::vector<Job>;

// Is given the number of a chain and the results of the jobs that ran, in order.
using ChainDone = std::function<void(std::size_t chain, const std::vector<JobResult>& results)>;
// Gives the next chain, none once there are no more. Who has none yet and long to look gives an empty one: those that
// run are looked after before it is asked again.
using NextChain = std::function<std::optional<JobChain>()>;

// Runs the chains, up to `atOnce` (1 or more) in parallel, started in order. This thread calls `next` when there is
// room for a chain, `done` when one ends, and `meanwhile` some fifty times a second. Exceptions from these calls
// propagate, and any exception that leaves this function ends all processes that still run. Only running chains are
// kept in memory.
void runJobs(const NextChain& next, int atOnce, const std::function<void()>& meanwhile, const ChainDone& done);

// The same for chains that are all known in advance; the progress is the fraction of them that has ended. Throws Error
// kCancelled as Progress does.
void runJobs(std::span<const JobChain> chains, int atOnce, Progress& progress, const ChainDone& done);

}  // namespace limber
