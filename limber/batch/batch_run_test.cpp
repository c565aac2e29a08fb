#include "limber/batch/batch_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <new>

#include "limber/batch/batch_record.h"
#include "limber/batch/batch_status.h"
#include "limber/core/error.h"
#include "limber/jobs/own_program.h"
#include "limber/jobs/sha256.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kNoMemoryCode = 3, kNoOutputCode = 9;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Copies a file, or does what its text says.
int copyOrMisbehave(const std::vector<std::string>& arguments, BatchWarnings& warnings) {
  const std::string text = textOf(arguments.at(1));
  if (text == "fail") {
    std::fprintf(stderr, "limber: %s: is broken\n", fs::path(arguments[1]).filename().c_str());
    return 1;
  }
  if (text == "crash") raise(SIGKILL);
  if (text == "endless") sleep(60);
  if (text == "huge") return kNoMemoryCode;
  if (text == "nothing") return 0;
  if (text == "warn") warnings.emplace_back("odd", 2);
  std::ofstream out(arguments.at(2), std::ios::binary);
  for (const std::string& argument : arguments) {
    if (argument != arguments[1] && argument != arguments[2]) out << argument << ' ';
  }
  out << text;
  return out ? 0 : kNoOutputCode;
}

class BatchRunTest : public ::testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
  }
  BatchPlan plan(const std::vector<std::string>& names) const {
    BatchPlan plan;
    plan.folder = folder_.path();
    plan.command = {"copy", std::string(kBatchInput), std::string(kBatchOutput)};
    plan.limits.seconds = 20;
    for (const std::string& name : names) plan.entries.push_back({name + ".obj", "sub/" + name + ".glb", {}, {}});
    return plan;
  }
  BatchOptions options() const {
    BatchOptions options;
    options.program = ownProgram();
    options.output = output();
    options.jobs = 2;
    options.outOfMemoryCode = kNoMemoryCode;
    options.command = copyOrMisbehave;
    return options;
  }
  fs::path output() const { return folder_.path() / "out"; }
  std::map<std::string, BatchRecord> records() const { return readBatchRecords(BatchFolder{output()}.records()); }

  testing::TemporaryFolder folder_;
};

TEST_F(BatchRunTest, WritesOutputsAndRecords) {
  put("a.obj", "one");
  put("b.obj", "warn");
  BatchPlan two = plan({"a", "b"});
  two.entries[1].options = {"--more"};
  const BatchProgress end = runBatch(two, options());
  EXPECT_EQ(end.done, 2u);
  EXPECT_EQ(textOf(output() / "sub/a.glb"), "copy --threads 1 one");
  EXPECT_EQ(textOf(output() / "sub/b.glb"), "copy --more --threads 1 warn");
  const BatchRecord a = records().at("sub/a.glb"), b = records().at("sub/b.glb");
  EXPECT_EQ(a.inputSha256, sha256OfFile(folder_.path() / "a.obj"));
  EXPECT_EQ(a.outputSha256, sha256OfFile(output() / "sub/a.glb"));
  EXPECT_GT(a.peakMemory, 0u);
  EXPECT_TRUE(a.warnings.empty());
  EXPECT_EQ(b.warnings, (BatchWarnings{{"odd", 2}}));
}

TEST_F(BatchRunTest, BadEntriesCostThemselvesAlone) {
  const std::vector<std::string> names = {"fail", "crash", "endless", "huge", "nothing", "good"};
  for (const std::string& name : names) put(name + ".obj", name);
  BatchPlan six = plan(names);
  six.entries.push_back({"missing.obj", "sub/missing.glb", {}, {}});
  six.entries.push_back({"good.obj", "sub/changed.glb", std::string(64, '0'), {}});
  six.limits.seconds = 1;
  const BatchProgress end = runBatch(six, options());
  EXPECT_EQ(end.done, 1u);
  EXPECT_EQ(end.failed, 7u);
  const auto all = records();
  EXPECT_EQ(all.at("sub/fail.glb").problem, "{input}: is broken");
  EXPECT_EQ(all.at("sub/crash.glb").outcome, JobOutcome::kCrashed);
  EXPECT_EQ(all.at("sub/endless.glb").outcome, JobOutcome::kTimedOut);
  EXPECT_EQ(all.at("sub/huge.glb").outcome, JobOutcome::kOutOfMemory);
  EXPECT_THAT(all.at("sub/nothing.glb").problem, HasSubstr("no output"));
  EXPECT_EQ(all.at("sub/missing.glb").outcome, JobOutcome::kFailed);
  EXPECT_THAT(all.at("sub/changed.glb").problem, HasSubstr("other bytes"));
  EXPECT_FALSE(fs::exists(output() / "sub/fail.glb"));
  const BatchStatus status = batchStatus(output());
  EXPECT_EQ(status.done, 1u);
  EXPECT_EQ(status.failed, 7u);
  EXPECT_EQ(status.open(), 0u);
  EXPECT_FALSE(status.isWell());
  EXPECT_THAT(status.failures, SizeIs(7));
}

TEST_F(BatchRunTest, InputsWithoutEndAreNotRead) {
  for (const char* name : {"good", "pipe", "large"}) put(std::string(name) + ".obj", name);
  fs::remove(folder_.path() / "pipe.obj");
  ASSERT_EQ(mkfifo((folder_.path() / "pipe.obj").c_str(), 0600), 0);
  BatchPlan three = plan({"pipe", "large", "good"});
  three.limits.memory = std::size_t{1} << 30;
  fs::resize_file(folder_.path() / "large.obj", three.limits.memory + 1);
  EXPECT_EQ(runBatch(three, options()).done, 1u);
  const auto all = records();
  EXPECT_EQ(all.at("sub/pipe.glb").problem, "is no plain file");
  EXPECT_EQ(all.at("sub/large.glb").problem, "is larger than the 1024 MB allowed");
}

TEST_F(BatchRunTest, DoesAgainWhatHasChangedAlone) {
  for (const char* name : {"a", "b", "c"}) put(std::string(name) + ".obj", name);
  put("fail.obj", "fail");
  BatchPlan four = plan({"a", "b", "c", "fail"});
  EXPECT_EQ(runBatch(four, options()).kept, 0u);
  EXPECT_EQ(runBatch(four, options()).kept, 4u);
  put("a.obj", "another");
  std::ofstream(output() / "sub/b.glb") << "not what was written";
  const BatchProgress again = runBatch(four, options());
  EXPECT_EQ(again.kept, 2u);
  EXPECT_EQ(again.done, 3u);
  EXPECT_EQ(textOf(output() / "sub/a.glb"), "copy --threads 1 another");
  EXPECT_EQ(textOf(output() / "sub/b.glb"), "copy --threads 1 b");
  BatchOptions retry = options();
  retry.retries = true;
  EXPECT_EQ(runBatch(four, retry).kept, 3u);
  four.command.emplace_back("--other");
  EXPECT_EQ(runBatch(four, options()).kept, 0u);
}

TEST_F(BatchRunTest, SeesFilesThatTheCommandNames) {
  put("a.obj", "a");
  put("walk.bvh", "steps");
  BatchPlan one = plan({"a"});
  one.command.emplace_back("walk.bvh");
  runBatch(one, options());
  EXPECT_EQ(runBatch(one, options()).kept, 1u);
  put("walk.bvh", "longer steps");
  EXPECT_EQ(runBatch(one, options()).kept, 0u);
  one.command.back() = "--motion=walk.bvh";
  runBatch(one, options());
  EXPECT_EQ(runBatch(one, options()).kept, 1u);
  put("walk.bvh", "steps");
  EXPECT_EQ(runBatch(one, options()).kept, 0u);
}

TEST_F(BatchRunTest, AFileThatTheCommandNamesIsRefusedForEachEntry) {
  put("a.obj", "a");
  put("b.obj", "b");
  put("large.bvh", "");
  BatchPlan two = plan({"a", "b"});
  two.command.emplace_back("large.bvh");
  two.limits.memory = std::size_t{1} << 30;
  fs::resize_file(folder_.path() / "large.bvh", two.limits.memory + 1);
  EXPECT_EQ(runBatch(two, options()).failed, 2u);
  for (const auto& [output, record] : records()) EXPECT_THAT(record.problem, HasSubstr("large.bvh: is larger than"));
}

TEST_F(BatchRunTest, ThreadsAreAddedWhereNothingIsSaidOfThem) {
  put("a.obj", "a");
  BatchPlan one = plan({"a"});
  one.command.emplace_back("--threads=4");
  runBatch(one, options());
  EXPECT_EQ(textOf(output() / "sub/a.glb"), "copy --threads=4 a");
}

TEST_F(BatchRunTest, WhatRunsIsWatchedWhileOthersAreLookedAt) {
  put("endless.obj", "endless");
  BatchPlan many = plan({"endless"});
  many.limits.seconds = 0.005;
  for (int i = 0; i < 10000; ++i) many.entries.push_back({"missing.obj", std::to_string(i) + ".glb", {}, {}});
  EXPECT_EQ(runBatch(many, options()).failed, many.entries.size());
  const std::string lines = textOf(BatchFolder{output()}.recordsOf({}));
  EXPECT_LT(lines.find("timed-out"), lines.rfind("9999.glb"));
}

TEST_F(BatchRunTest, ShardsMakeTheWhole) {
  std::vector<std::string> names;
  for (int i = 0; i < 7; ++i) {
    names.push_back("m" + std::to_string(i));
    put(names.back() + ".obj", names.back());
  }
  std::size_t entries = 0;
  for (std::size_t shard = 1; shard <= 3; ++shard) {
    BatchOptions part = options();
    part.shard = {shard, 3};
    EXPECT_FALSE(shard > 1 && batchStatus(output()).isWell());
    entries += runBatch(plan(names), part).done;
  }
  EXPECT_EQ(entries, names.size());
  EXPECT_TRUE(batchStatus(output()).isWell());
  EXPECT_EQ(runBatch(plan(names), options()).kept, names.size());  // as one shard: what others did counts
  const std::string merged = mergedBatchRecords(output());
  EXPECT_EQ(std::count(merged.begin(), merged.end(), '\n'), 7);
  EXPECT_TRUE(batchStatus(output()).isWell());
  fs::remove(output() / "sub/m3.glb");
  EXPECT_EQ(batchStatus(output()).lost, 1u);
  EXPECT_FALSE(batchStatus(output()).isWell());
}

TEST_F(BatchRunTest, GoesOnWhereItWasStopped) {
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i) {
    names.push_back("m" + std::to_string(i));
    put(names.back() + ".obj", names.back());
  }
  BatchOptions stopped = options();
  stopped.tell = [](const BatchProgress& at) {
    if (at.done >= 3) throw Error(ErrorCode::kCancelled, "stopped");
  };
  EXPECT_THROW(runBatch(plan(names), stopped), Error);
  const std::size_t before = records().size();
  EXPECT_GE(before, 3u);
  const BatchProgress end = runBatch(plan(names), options());
  EXPECT_EQ(end.kept, before);
  EXPECT_EQ(end.done, names.size());
}

TEST_F(BatchRunTest, ALaterRunCountsInHoweverManyShards) {
  put("a.obj", "fail");
  put("b.obj", "b");
  BatchOptions second = options();
  second.shard = {2, 2};
  runBatch(plan({"b", "a"}), second);
  EXPECT_EQ(batchStatus(output()).failed, 1u);
  put("a.obj", "a");
  runBatch(plan({"b", "a"}), options());
  EXPECT_TRUE(batchStatus(output()).isWell());
  EXPECT_EQ(records().at("sub/a.glb").run, 2u);
}

TEST_F(BatchRunTest, TakesAFolderThatAnotherShardHasJustBegun) {
  fs::create_directories(BatchFolder{output()}.own());
  put("a.obj", "a");
  EXPECT_EQ(runBatch(plan({"a"}), options()).done, 1u);
}

TEST_F(BatchRunTest, RefusesAFolderOfOtherFiles) {
  fs::create_directories(output());
  std::ofstream(output() / "diary.txt") << "mine";
  EXPECT_THROW(runBatch(plan({}), options()), Error);
  EXPECT_THROW(batchStatus(output()), Error);
  EXPECT_EQ(textOf(output() / "diary.txt"), "mine");
}

}  // namespace
}  // namespace limber
