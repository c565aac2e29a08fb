#include "limber/jobs/process_group.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "limber/core/error.h"
#include "limber/jobs/job_pool.h"
#include "limber/jobs/own_program.h"
#include "limber/jobs/running_job.h"
#include "process_state.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using testing::endsSoon;

// Run by the tests below in a process of its own: one that runs a program that hangs, as does a child of that one.
TEST(ProcessGroupChild, DISABLED_RunsAProgramThatHangs) {
  Job job;
  job.command = {"/bin/sh", "-c", "sleep 1000 & echo $PPID $$ $! > begun; mv begun pids; wait"};
  job.folder = fs::current_path();
  Progress progress;
  const JobChain chain = {job};
  runJobs({&chain, 1}, 1, progress, [](std::size_t, const auto&) {});
}

class ProcessGroups : public ::testing::Test {
 protected:
  // The program that runs, the one that it runs, and a child of that one.
  struct Generations {
    pid_t program = 0, child = 0, grandchild = 0;
  };

  // Returns when all three run.
  Generations start() {
    Job job;
    job.command = {ownProgram().string(), "--gtest_also_run_disabled_tests",
                   "--gtest_filter=ProcessGroupChild.DISABLED_RunsAProgramThatHangs"};
    job.folder = folder_.path();
    job_ = std::make_unique<RunningJob>(job);
    Generations pids;
    for (int i = 0; i < 4000 && !fs::exists(folder_.path() / "pids"); ++i) usleep(5000);
    std::ifstream(folder_.path() / "pids") >> pids.program >> pids.child >> pids.grandchild;
    EXPECT_GT(pids.grandchild, 0);
    return pids;
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<RunningJob> job_;
};

TEST_F(ProcessGroups, EndingAJobEndsAllGenerations) {
  const Generations pids = start();
  job_.reset();
  for (const pid_t pid : {pids.program, pids.child, pids.grandchild}) EXPECT_TRUE(endsSoon(pid));
}

TEST_F(ProcessGroups, AProgramThatIsKilledTakesAllGenerationsWithIt) {
  const Generations pids = start();
  ASSERT_EQ(kill(pids.program, SIGKILL), 0);
  for (const pid_t pid : {pids.child, pids.grandchild}) EXPECT_TRUE(endsSoon(pid));
}

TEST(ProcessGroup, IsThereUntilItIsEnded) {
  ProcessGroup group;
  const pid_t guard = group.id();
  EXPECT_EQ(getpgid(guard), guard);
  EXPECT_NE(getpgid(guard), getpgid(0));
  int status = 0;
  EXPECT_EQ(waitpid(guard, &status, WNOHANG), 0);
  group.end();
  EXPECT_EQ(waitpid(guard, &status, WNOHANG), -1);  // collected
  group.end();
}

}  // namespace
}  // namespace limber
