#include "limber/adapters/program_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <filesystem>

#include "limber/core/error.h"
#include "limber/core/sanitizers.h"
#include "temporary_folder.h"
#include "testing/made_body.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::shellAdapter;

const Bytes kGiven = {'g', 'i', 'v', 'e', 'n'};

std::string textFrom(const Adapter& adapter) {
  Progress progress;
  const ProgramOutput output = runProgram(adapter, {kGiven}, progress);
  return {output.bytes.begin(), output.bytes.end()};
}

std::string runProblem(const Adapter& adapter) {
  try {
    textFrom(adapter);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(ProgramRun, FilesGoInAndOneComesOut) {
  Adapter adapter = shellAdapter("cat \"$1\" > \"$2\"; echo \" $3\" >> \"$2\"");
  adapter.seed = 42;
  EXPECT_EQ(textFrom(adapter), "given 42\n");
}

TEST(ProgramRun, StepsFollowEachOtherInFoldersOfTheirOwn) {
  const testing::TemporaryFolder folder;
  Adapter adapter = shellAdapter("pwd -P > between");
  adapter.steps.push_back({{"/bin/sh", "-c", "cat between > \"$0\"; pwd -P >> \"$0\"", "{output}"}, folder.path()});
  adapter.steps[0].folder = folder.path();
  const std::string at = std::filesystem::canonical(folder.path()).string();
  EXPECT_EQ(textFrom(adapter), at + "\n" + at + "\n");
}

TEST(ProgramRun, AProgramIsFoundAsAShellFindsIt) {
  Adapter adapter = shellAdapter("");
  adapter.steps = {{{"cp", "{input}", "{output}"}, {}}};
  EXPECT_EQ(textFrom(adapter), "given");
}

TEST(ProgramRun, NothingOfARunIsLeft) {
  Adapter adapter = shellAdapter("dirname \"$2\" > \"$2\"");
  std::string made = textFrom(adapter);
  made.pop_back();
  EXPECT_THAT(made, HasSubstr("limber-run-"));
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(made).parent_path()));
}

TEST(ProgramRun, ArgumentsAreNoShellText) {
  Adapter adapter = shellAdapter("");
  adapter.steps = {{{"/bin/sh", "-c", "printf '%s|' \"$@\" > \"$0\"", "{output}", "$HOME", "a b", "; exit 1"}, {}}};
  EXPECT_EQ(textFrom(adapter), "$HOME|a b|; exit 1|");
}

TEST(ProgramRun, AHangIsEnded) {
  Adapter adapter = shellAdapter("sleep 100");
  adapter.limits.seconds = 0.2;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(runProblem(adapter), HasSubstr("fake: step 1 (/bin/sh): did not end within 0.2 s"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(ProgramRun, ACrashSaysSoWithTheLastWords) {
  EXPECT_THAT(runProblem(shellAdapter("echo loading >&2; kill -SEGV $$")),
              AllOf(HasSubstr("fake: step 1 (/bin/sh): crashed: signal 11"), HasSubstr("its last words: loading")));
}

TEST(ProgramRun, AFailureSaysSoWithTheLastWords) {
  const std::string problem =
      runProblem(shellAdapter("echo Traceback >&2; printf 'no\\tcheckpoint\\n\\n' >&2; exit 3"));
  EXPECT_THAT(problem, AllOf(HasSubstr("failed: exit code 3; its last words: no checkpoint"), Not(HasSubstr("\n"))));
  EXPECT_THAT(runProblem(shellAdapter("echo \"$1\" > \"$2\"; exit 1")), HasSubstr("failed: exit code 1"));
}

TEST(ProgramRun, RunningOutOfMemorySaysSo) {
  for (const char* words : {"MemoryError", "torch.OutOfMemoryError: CUDA out of memory.", "what():  std::bad_alloc",
                            "cat: Cannot allocate memory"}) {
    EXPECT_THAT(runProblem(shellAdapter(fmt::format("echo '{}' >&2; exit 1", words))),
                AllOf(HasSubstr("ran out of memory (its limit is "), HasSubstr(words), HasSubstr("\"memory_mb\"")));
  }
  EXPECT_THAT(runProblem(shellAdapter("kill -KILL $$")), HasSubstr("ran out of memory"));
  EXPECT_THAT(runProblem(shellAdapter("echo memory is fine >&2; exit 1")), Not(HasSubstr("ran out")));
}

#ifdef __linux__  // elsewhere it is not RLIMIT_DATA
// The limit is the adapter's, also below a program that has a smaller one of its own, as a study's cells have.
TEST(ProgramRun, TheLimitOfMemoryIsTheAdaptersOwn) {
  if (kAddressSanitizer) GTEST_SKIP() << "which takes terabytes of addresses for itself";
  Adapter adapter = shellAdapter("ulimit -d > \"$2\"");
  adapter.limits.memory = std::size_t{3000} << 20;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_DATA, &before), 0);
  const rlimit small{std::size_t{2000} << 20, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_DATA, &small), 0);
  const std::string text = textFrom(adapter);
  setrlimit(RLIMIT_DATA, &before);
  EXPECT_EQ(text, std::to_string(3000 << 10) + "\n");
}
#endif

TEST(ProgramRun, AFirstStepThatFailsIsTheLastThatRuns) {
  Adapter adapter = shellAdapter("exit 1");
  adapter.steps.push_back({{"cp", "{input}", "{output}"}, {}});
  EXPECT_THAT(runProblem(adapter), HasSubstr("step 1"));
}

TEST(ProgramRun, ExitCode0ProvesNothing) {
  EXPECT_THAT(runProblem(shellAdapter("echo out of CUDA memory; exit 0")),
              HasSubstr("fake: wrote no output/model.txt; its last words: out of CUDA memory"));
  EXPECT_THAT(runProblem(shellAdapter(": > \"$2\"")), HasSubstr("left an empty output/model.txt"));
  EXPECT_THAT(runProblem(shellAdapter("mkdir \"$2\"")), HasSubstr("wrote no output/model.txt"));
}

TEST(ProgramRun, WhatIsNotThereCannotBeRun) {
  Adapter adapter = shellAdapter("");
  adapter.steps = {{{"limber-no-such-program", "{input}"}, {}}};
  EXPECT_THAT(runProblem(adapter), HasSubstr("step 1 (limber-no-such-program): cannot be run: No such file"));
  adapter.steps = {{{"/bin/sh", "{input}"}, "/no/such/folder"}};
  EXPECT_THAT(runProblem(adapter), HasSubstr("cannot be run"));
}

TEST(ProgramRun, ACancelEndsIt) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(runProgram(shellAdapter("sleep 100"), {kGiven}, progress), Error);
}

}  // namespace
}  // namespace limber
