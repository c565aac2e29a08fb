#include "limber/jobs/job_pool.h"

#include <poll.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "limber/core/error.h"
#include "limber/jobs/running_job.h"

namespace limber {

namespace {

constexpr double kSlice = 0.02;  // seconds after which processes are looked at that have closed their output

struct RunningChain {
  std::size_t chain = 0;
  std::unique_ptr<RunningJob> job;
  std::vector<JobResult> results;
};

// Until one of them says something or ends, or a slice has passed.
void waitForNews(const std::vector<RunningChain>& running) {
  std::vector<pollfd> pipes;
  double next = secondsNow() + kSlice;
  for (const RunningChain& one : running) {
    for (const int pipe : {one.job->outputPipe(), one.job->errorPipe()}) {
      if (pipe >= 0) pipes.push_back({pipe, POLLIN, 0});
    }
    next = std::min(next, one.job->deadline());
  }
  const double wait = std::max(0.0, next - secondsNow());
  poll(pipes.data(), pipes.size(), static_cast<int>(1000 * wait) + 1);
}

// Takes the next job of the chain up where one has ended; false when the chain is over.
bool goOn(RunningChain& one, std::span<const JobChain> chains) {
  if (!one.job->isOver()) return true;
  one.results.push_back(one.job->takeResult());
  const JobChain& jobs = chains[one.chain];
  if (one.results.back().outcome != JobOutcome::kDone || one.results.size() == jobs.size()) return false;
  one.job = std::make_unique<RunningJob>(jobs[one.results.size()]);
  return true;
}

}  // namespace

void runJobs(std::span<const JobChain> chains, int atOnce, Progress& progress, const ChainDone& done) {
  if (atOnce < 1) throw Error(ErrorCode::kBadArgument, "jobs run one at a time or more");
  std::vector<RunningChain> running;
  std::size_t begun = 0, ended = 0;
  while (ended < chains.size()) {
    progress.update(static_cast<double>(ended) / static_cast<double>(chains.size()));
    while (begun < chains.size() && running.size() < static_cast<std::size_t>(atOnce)) {
      const std::size_t chain = begun++;
      if (chains[chain].empty()) {
        done(chain, {});
        ++ended;
        continue;
      }
      running.push_back({chain, std::make_unique<RunningJob>(chains[chain].front()), {}});
    }
    if (running.empty()) continue;
    waitForNews(running);
    for (std::size_t i = 0; i < running.size();) {
      if (goOn(running[i], chains)) {
        ++i;
        continue;
      }
      const RunningChain over = std::move(running[i]);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      ++ended;
      done(over.chain, over.results);
    }
  }
}

}  // namespace limber
