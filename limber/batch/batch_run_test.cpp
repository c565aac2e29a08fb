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
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

constexpr int kNoMemoryCode = 3, kStorageCode = 5, kNoOutputCode = 9;

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Copies a file, or does what its text says.
int copyOrMisbehave(const std::vector<std::string>& arguments, const fs::path& output, BatchWarnings& warnings) {
  const std::string text = textOf(arguments.at(1));
  if (text == "fail") {
    std::fprintf(stderr, "limber: %s: is broken\n", fs::path(arguments[1]).filename().c_str());
    return 1;
  }
  if (text == "temporary") {
    const fs::path left = fs::temp_directory_path() / "left";
    fs::create_directory(left);
    std::ofstream(left / "model") << text;
    std::ofstream(output.parent_path().parent_path().parent_path() / "where") << left.string();
    raise(SIGKILL);
  }
  if (text == "crash") raise(SIGKILL);
  if (text == "endless") sleep(60);
  if (text == "huge") return kNoMemoryCode;
  if (text == "nothing") return 0;
  if (text == "warn") warnings.emplace_back("odd", 2);
  if (text == "full" || text == "refused") {
    std::fprintf(stderr, "limber: %s: cannot be written: %s\n", arguments.at(2).c_str(), text.c_str());
    return text == "full" ? kStorageCode : 1;
  }
  if (text == "several") std::ofstream(fs::path(arguments.at(2)).replace_extension(".bin")) << text;
  if (text == "print") {
    std::printf("%s", arguments.at(2).c_str());
    return 0;
  }
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
    options.storageCode = kStorageCode;
    options.command = copyOrMisbehave;
    return options;
  }
  fs::path output() const { return folder_.path() / "out"; }
  std::map<std::string, BatchRecord> records() const {
    Warnings warnings;
    return readBatchRecords(BatchFolder{output()}.records(), warnings);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(BatchRunTest, TemporaryFilesOfAnEntryThatIsEndedGoWithIt) {
  put("a.obj", "temporary");
  EXPECT_EQ(runBatch(plan({"a"}), options()).failed, 1u);
  const fs::path left = textOf(BatchFolder{output()}.own() / "where");
  EXPECT_THAT(left.string(), HasSubstr(BatchFolder{output()}.own().string()));
  EXPECT_FALSE(fs::exists(left));
}

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

TEST_F(BatchRunTest, NoThreadsAreAddedToACommandThatTakesNone) {
  put("a.obj", "a");
  BatchOptions without = options();
  without.takesThreads = false;
  runBatch(plan({"a"}), without);
  EXPECT_EQ(textOf(output() / "sub/a.glb"), "copy a");
}

TEST_F(BatchRunTest, WhatIsPrintedIsTheOutputWhereThePlanNamesNone) {
  put("a.obj", "print");
  BatchPlan printing = plan({"a"});
  printing.command = {"copy", std::string(kBatchInput), "words"};
  EXPECT_EQ(runBatch(printing, options()).done, 1u);
  EXPECT_EQ(textOf(output() / "sub/a.glb"), "words");
}

TEST_F(BatchRunTest, AFullDiskEndsTheBatchAndIsNoEntrysFailure) {
  put("a.obj", "full");
  put("b.obj", "b");
  BatchOptions oneByOne = options();
  oneByOne.jobs = 1;
  try {
    runBatch(plan({"b", "a"}), oneByOne);
    FAIL() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFile);
    EXPECT_THAT(error.what(), HasSubstr("a.glb: cannot be written: full"));
  }
  EXPECT_THAT(records(), SizeIs(1));
  put("a.obj", "a");
  const BatchProgress end = runBatch(plan({"b", "a"}), options());
  EXPECT_EQ(end.kept, 1u);
  EXPECT_EQ(end.done, 2u);
}

TEST_F(BatchRunTest, AlikeFailuresReadAlikeWhereverTheEntryWorks) {
  put("a.obj", "refused");
  put("b.obj", "refused");
  runBatch(plan({"a", "b"}), options());
  const BatchStatus status = batchStatus(output());
  ASSERT_THAT(status.failures, SizeIs(1));
  EXPECT_EQ(status.failures[0].problem, "{output}: cannot be written: refused");
}

TEST_F(BatchRunTest, FilesBesideTheOutputAreNotLostUnsaid) {
  put("a.obj", "several");
  EXPECT_EQ(runBatch(plan({"a"}), options()).failed, 1u);
  EXPECT_THAT(records().at("sub/a.glb").problem, HasSubstr("'*.bin' beside its output"));
}

TEST_F(BatchRunTest, AnOutputMayHaveAnyName) {
  put("a.obj", "warn");
  BatchPlan one = plan({"a"});
  for (const char* name : {"warnings.json", "0.json", "0"}) {
    one.entries[0].output = name;
    EXPECT_EQ(runBatch(one, options()).done, 1u);
    EXPECT_EQ(textOf(output() / name), "copy --threads 1 warn");
    EXPECT_EQ(records().at(name).warnings, (BatchWarnings{{"odd", 2}}));
  }
}

TEST_F(BatchRunTest, WhatLiesInAnOutputsPlaceCostsThatEntryAlone) {
  for (const char* name : {"a", "b", "c"}) put(std::string(name) + ".obj", name);
  fs::create_directories(output() / ".limber-batch");
  fs::create_directories(output() / "sub/a.glb");
  std::ofstream(output() / "file") << "mine";
  BatchPlan three = plan({"a", "b", "c"});
  three.entries[2].output = "file/c.glb";
  const BatchProgress end = runBatch(three, options());
  EXPECT_EQ(end.done, 1u);
  EXPECT_EQ(records().at("sub/a.glb").problem, "a folder lies where the output is to be");
  EXPECT_EQ(records().at("file/c.glb").problem, "a file lies where the output's folder is to be");
  fs::remove(output() / "sub/a.glb");
  fs::remove(output() / "file");
  EXPECT_EQ(runBatch(three, options()).done, 3u);
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

TEST_F(BatchRunTest, StatusCountsEntriesOfAnotherTaskAsOpen) {
  for (const char* name : {"a", "b", "walk"}) put(std::string(name) + ".obj", name);
  BatchPlan two = plan({"a", "b"});
  two.command.emplace_back("walk.obj");
  BatchOptions first = options();
  first.shard = {1, 2};
  runBatch(two, options());
  const auto expectOneOpen = [&] {
    runBatch(two, first);
    EXPECT_EQ(batchStatus(output()).outdated, 1u);
    EXPECT_EQ(batchStatus(output()).open(), 1u);
    EXPECT_THAT(mergedBatchRecords(output()), Not(HasSubstr("b.glb")));
    runBatch(two, options());
    EXPECT_TRUE(batchStatus(output()).isWell());
  };
  two.command.emplace_back("--other");
  expectOneOpen();
  put("walk.obj", "other steps");
  expectOneOpen();
  two.entries[1].options = {"--more"};
  expectOneOpen();
}

TEST_F(BatchRunTest, StatusOfAnEarlierVersionsFolderIsAsItWas) {
  put("a.obj", "a");
  runBatch(plan({"a"}), options());
  const auto without = [](const fs::path& file, const char* key) {
    std::string text = textOf(file);
    const std::size_t begin = text.find(key), end = text.find(',', begin);
    std::ofstream(file, std::ios::binary) << text.erase(begin, end + 1 - begin);
  };
  without(BatchFolder{output()}.recordsOf({}), "\"task\"");
  EXPECT_EQ(batchStatus(output()).outdated, 1u);
  without(BatchFolder{output()}.plan(), "\"task\"");
  EXPECT_TRUE(batchStatus(output()).isWell());
}

TEST_F(BatchRunTest, StatusNamesOutputsOfEarlierPlans) {
  for (const char* name : {"a", "b", "c"}) put(std::string(name) + ".obj", name);
  put("fail.obj", "fail");
  runBatch(plan({"a", "b", "c", "fail"}), options());
  runBatch(plan({"a"}), options());
  fs::remove(output() / "sub/c.glb");
  EXPECT_THAT(batchStatus(output()).leftOver, ElementsAre("sub/b.glb"));
  EXPECT_TRUE(batchStatus(output()).isWell());
}

TEST_F(BatchRunTest, GoesOnPastRecordsThatAreDamaged) {
  for (const char* name : {"a", "b"}) put(std::string(name) + ".obj", name);
  runBatch(plan({"a", "b"}), options());
  const fs::path file = BatchFolder{output()}.recordsOf({});
  const std::string lines = textOf(file);
  std::ofstream(file, std::ios::binary) << "garbage" << lines;  // what stood in the first line is lost
  EXPECT_EQ(batchStatus(output()).open(), 1u);
  EXPECT_THAT(batchStatus(output()).recordWarnings.items(), SizeIs(1));
  const BatchProgress end = runBatch(plan({"a", "b"}), options());
  EXPECT_EQ(end.kept, 1u);
  EXPECT_THAT(end.recordWarnings.items(), SizeIs(1));
  EXPECT_TRUE(batchStatus(output()).isWell());
}

TEST_F(BatchRunTest, TakesAFolderThatAnotherShardHasJustBegun) {
  fs::create_directories(BatchFolder{output()}.own());
  put("a.obj", "a");
  EXPECT_EQ(runBatch(plan({"a"}), options()).done, 1u);
}

TEST_F(BatchRunTest, RefusesAFolderOfOtherFiles) {
  fs::create_directories(output());
  std::ofstream(output() / "diary.txt") << "mine";
  EXPECT_THROW(batchStatus(output()), Error);
  BatchOptions elsewhere = options();
  for (const char* location : {"out", "out/diary.txt", "out/diary.txt/in"}) {
    elsewhere.output = folder_.path() / location;
    try {
      runBatch(plan({}), elsewhere);
      ADD_FAILURE() << location;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument) << error.what();
    }
  }
  EXPECT_EQ(textOf(output() / "diary.txt"), "mine");
}

}  // namespace
}  // namespace limber
