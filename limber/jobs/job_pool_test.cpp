#include "limber/jobs/job_pool.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "limber/core/error.h"
#include "limber/core/sanitizers.h"
#include "limber/jobs/own_program.h"
#include "process_state.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kNoMemoryCode = 77;

Job shell(const std::string& script) {
  Job job;
  job.command = {"/bin/sh", "-c", script};
  job.limits.seconds = 20;
  return job;
}

std::vector<JobResult> runChain(const JobChain& chain) {
  std::vector<JobResult> results;
  Progress progress;
  runJobs({&chain, 1}, 1, progress, [&](std::size_t, const std::vector<JobResult>& r) { results = r; });
  return results;
}

JobResult runOne(const Job& job) {
  const std::vector<JobResult> results = runChain({job});
  return results.empty() ? JobResult{} : results.front();
}

TEST(JobPool, TellsCodesAndOutput) {
  const JobResult result = runOne(shell("echo told; echo why >&2; exit 3"));
  EXPECT_EQ(result.outcome, JobOutcome::kFailed);
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.out, "told\n");
  EXPECT_EQ(result.error, "why\n");
  EXPECT_GT(result.peakMemory, 0u);
  EXPECT_EQ(runOne(shell("true")).outcome, JobOutcome::kDone);
}

TEST(JobPool, RunsWorkInAChild) {
  int here = 0;
  Job job;
  job.work = [&] {
    here = 1;
    std::fprintf(stderr, "from within");
    return 5;
  };
  const JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kFailed);
  EXPECT_EQ(result.code, 5);
  EXPECT_EQ(result.error, "from within");
  EXPECT_EQ(here, 0);
}

// If a child kept a file's lock, it would outlive the program that was ended.
TEST(JobPool, WorkHasNoneOfTheProgramsFiles) {
  const testing::TemporaryFolder folder;
  const int file = open((folder.path() / "lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600);
  ASSERT_GE(file, 0);
  Job job;
  job.work = [file] { return fcntl(file, F_GETFD) < 0 ? 0 : 1; };
  EXPECT_EQ(runOne(job).code, 0);
  EXPECT_GE(fcntl(file, F_GETFD), 0);
  close(file);
}

TEST(JobPool, TellsASignalFromACode) {
  const JobResult result = runOne(shell("kill -SEGV $$"));
  EXPECT_EQ(result.outcome, JobOutcome::kCrashed);
  EXPECT_EQ(result.code, SIGSEGV);
}

TEST(JobPool, ArgumentsAreNoShellText) {
  Job job;
  job.command = {"/bin/echo", "$HOME", "a  b", "'\"; exit 1"};
  EXPECT_EQ(runOne(job).out, "$HOME a  b '\"; exit 1\n");
}

TEST(JobPool, StandardInputIsEmpty) {
  EXPECT_EQ(runOne(shell("cat; echo end")).out, "end\n");
}

TEST(JobPool, WorksInItsFolder) {
  Job job = shell("pwd -P");
  job.folder = "/";
  EXPECT_EQ(runOne(job).out, "/\n");
  job.folder = "/no/such/folder";
  const JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kNotStarted);
  EXPECT_EQ(result.code, ENOENT);
}

TEST(JobPool, AProgramThatIsNotThereIsAResult) {
  Job job;
  job.command = {"/no/such/program"};
  const JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kNotStarted);
  EXPECT_EQ(result.code, ENOENT);
  EXPECT_THAT(jobOutcomeText(job, result), HasSubstr("cannot be run"));
}

TEST(JobPool, TimeEndsTheWholeGroup) {
  Job job = shell("sleep 100 & echo $!; wait");
  job.limits.seconds = 0.2;
  const JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(jobOutcomeText(job, result), "more than 0.2 s");
  EXPECT_TRUE(testing::endsSoon(std::stoi(result.out)));
}

TEST(JobPool, WhatAJobLeavesRunningEndsWithIt) {
  const JobResult result = runOne(shell("sleep 100 & echo $!"));
  EXPECT_EQ(result.outcome, JobOutcome::kDone);
  EXPECT_LT(result.seconds, 20);
  EXPECT_TRUE(testing::endsSoon(std::stoi(result.out)));
}

TEST(JobPool, KeepsTheLastOfALongOutput) {
  Job job = shell("i=0; while [ $i -lt 2000 ]; do echo line $i; i=$((i+1)); done");
  job.maxOutput = 100;
  const JobResult result = runOne(job);
  EXPECT_THAT(result.out, AllOf(SizeIs(100), EndsWith("line 1999\n")));
}

TEST(JobPool, EndlessOutputEndsInTime) {
  Job job;
  job.command = {"/bin/cat", "/dev/zero"};
  job.limits.seconds = 0.2;
  job.maxOutput = 1000;
  const JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(result.out, std::string(1000, '\0'));
}

// Run by the test below in a process of its own.
TEST(JobPoolChild, DISABLED_TakesTwoHundredMegabytes) {
  std::set_new_handler([] { _exit(kNoMemoryCode); });
  std::vector<std::string> taken;
  for (int i = 0; i < 200; ++i) taken.emplace_back(std::size_t{1} << 20, 'x');
  std::printf("%zu\n", taken.size());
}

TEST(JobPool, MemoryIsLimitedBeforeTheProgramBegins) {
  if (kAddressSanitizer) GTEST_SKIP() << "which takes terabytes of addresses for itself";
  Job job;
  job.command = {ownProgram().string(), "--gtest_also_run_disabled_tests",
                 "--gtest_filter=JobPoolChild.DISABLED_TakesTwoHundredMegabytes"};
  job.outOfMemoryCode = kNoMemoryCode;
  job.limits.memory = std::size_t{100} << 20;
  JobResult result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kOutOfMemory) << result.out << result.error;
  EXPECT_EQ(jobOutcomeText(job, result), "more than 100 MB of memory");
  EXPECT_LT(result.peakMemory, std::size_t{120} << 20);
  job.limits.memory = std::size_t{400} << 20;
  result = runOne(job);
  EXPECT_EQ(result.outcome, JobOutcome::kDone) << result.error;
  EXPECT_GT(result.peakMemory, std::size_t{200} << 20);
}

TEST(JobPool, AChainStopsAtTheFirstThatIsNotDone) {
  const std::vector<JobResult> results = runChain({shell("echo 1"), shell("exit 4"), shell("echo 3")});
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].out, "1\n");
  EXPECT_EQ(results[1].code, 4);
  EXPECT_EQ(runChain({shell("echo 1"), shell("echo 2"), shell("echo 3")}).size(), 3u);
  EXPECT_TRUE(runChain({}).empty());
}

// Each waits until as many as run at once have begun: fewer would run out of time.
TEST(JobPool, RunsAsManyAtOnceAsAsked) {
  const testing::TemporaryFolder folder;
  std::vector<JobChain> chains;
  for (int i = 0; i < 6; ++i) {
    Job job = shell("touch " + std::to_string(i) + "; while [ $(ls | wc -l) -lt 3 ]; do sleep 0.01; done");
    job.folder = folder.path();
    chains.push_back({job});
  }
  std::vector<bool> isDone(chains.size());
  Progress progress;
  runJobs(chains, 3, progress, [&](std::size_t chain, const std::vector<JobResult>& results) {
    isDone[chain] = results.front().outcome == JobOutcome::kDone;
  });
  EXPECT_THAT(isDone, ::testing::Each(true));
}

TEST(JobPool, CancellingEndsWhatRuns) {
  Progress progress;
  std::thread canceller([&] {
    usleep(100000);
    progress.cancel();
  });
  const JobChain chain = {shell("sleep 100")};
  const double start = secondsNow();
  EXPECT_THROW(runJobs({&chain, 1}, 1, progress, [](std::size_t, const auto&) {}), Error);
  EXPECT_LT(secondsNow() - start, 20);
  canceller.join();
}

TEST(JobPool, WhatRunsIsWatchedWhileTheNextIsLookedFor) {
  Job endless = shell("sleep 100");
  endless.limits.seconds = 0.1;
  bool isBegun = false, isOver = false;
  const double start = secondsNow();
  const auto next = [&]() -> std::optional<JobChain> {
    if (!std::exchange(isBegun, true)) return JobChain{endless};
    if (isOver || secondsNow() - start > 20) return std::nullopt;
    return JobChain{};
  };
  runJobs(
      next, 2, [] {}, [&](std::size_t chain, const std::vector<JobResult>&) { isOver = isOver || chain == 0; });
  EXPECT_TRUE(isOver);
}

TEST(JobPool, RefusesWhatMakesNoSense) {
  Progress progress;
  EXPECT_THROW(runJobs({}, 0, progress, [](std::size_t, const auto&) {}), Error);
  const JobChain none = {Job{}};
  EXPECT_THROW(runJobs({&none, 1}, 1, progress, [](std::size_t, const auto&) {}), Error);
}

TEST(JobOutcome, NamesAreFoundAgain) {
  for (const JobOutcome outcome : {JobOutcome::kDone, JobOutcome::kFailed, JobOutcome::kCrashed, JobOutcome::kTimedOut,
                                   JobOutcome::kOutOfMemory, JobOutcome::kNotStarted}) {
    EXPECT_EQ(findJobOutcome(jobOutcomeName(outcome)), outcome);
  }
  EXPECT_THROW(findJobOutcome("lost"), Error);
}

}  // namespace
}  // namespace limber
