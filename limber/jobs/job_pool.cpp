#include "limber/jobs/job_pool.h"

#include <poll.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "limber/core/error.h"
#include "limber/jobs/running_job.h"

namespace limber {

namespace {

// Seconds after which processes are looked at again: those that have closed their output are about to end.
constexpr double kSlice = 0.02, kEndingSlice = 0.001;

struct RunningChain {
  std::size_t number = 0;
  JobChain jobs;
  std::unique_ptr<RunningJob> job;
  std::vector<JobResult> results;
};

// Until one of them says something or ends, or a slice has passed.
void waitForNews(const std::vector<RunningChain>& running) {
  std::vector<pollfd> pipes;
  const double now = secondsNow();
  double next = now + kSlice;
  for (const RunningChain& one : running) {
    for (const int pipe : {one.job->outputPipe(), one.job->errorPipe()}) {
      if (pipe >= 0) pipes.push_back({pipe, POLLIN, 0});
    }
    const bool isEnding = one.job->outputPipe() < 0 && one.job->errorPipe() < 0;
    next = std::min({next, one.job->deadline(), isEnding ? now + kEndingSlice : next});
  }
  const double wait = std::max(0.0, next - now);
  poll(pipes.data(), pipes.size(), static_cast<int>(1000 * wait) + 1);
}

// Takes the next job of the chain up where one has ended; false when the chain is over.
bool goOn(RunningChain& one) {
  if (!one.job->isOver()) return true;
  one.results.push_back(one.job->takeResult());
  if (one.results.back().outcome != JobOutcome::kDone || one.results.size() == one.jobs.size()) return false;
  one.job = std::make_unique<RunningJob>(one.jobs[one.results.size()]);
  return true;
}

}  // namespace

void runJobs(const NextChain& next, int atOnce, const std::function<void()>& meanwhile, const ChainDone& done) {
  if (atOnce < 1) throw Error(ErrorCode::kBadArgument, "jobs run one at a time or more");
  std::vector<RunningChain> running;
  std::size_t begun = 0;
  bool hasMore = true;
  while (hasMore || !running.empty()) {
    meanwhile();
    bool isAskedAgain = false;
    while (!isAskedAgain && hasMore && running.size() < static_cast<std::size_t>(atOnce)) {
      std::optional<JobChain> chain = next();
      hasMore = chain.has_value();
      if (!hasMore) break;
      const std::size_t number = begun++;
      if (chain->empty()) {
        done(number, {});
        isAskedAgain = true;
        continue;
      }
      auto job = std::make_unique<RunningJob>(chain->front());
      running.push_back({number, std::move(*chain), std::move(job), {}});
    }
    if (!isAskedAgain && !running.empty()) waitForNews(running);
    for (std::size_t i = 0; i < running.size();) {
      if (goOn(running[i])) {
        ++i;
        continue;
      }
      const RunningChain over = std::move(running[i]);
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      done(over.number, over.results);
    }
  }
}

void runJobs(std::span<const JobChain> chains, int atOnce, Progress& progress, const ChainDone& done) {
  std::size_t begun = 0, ended = 0;
  const auto next = [&]() -> std::optional<JobChain> {
    if (begun == chains.size()) return std::nullopt;
    return chains[begun++];
  };
  const auto tell = [&] {
    if (!chains.empty()) progress.update(static_cast<double>(ended) / static_cast<double>(chains.size()));
  };
  runJobs(next, atOnce, tell, [&](std::size_t chain, const std::vector<JobResult>& results) {
    ++ended;
    done(chain, results);
  });
}

}  // namespace limber
