#include "limber/batch/batch_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kCommands[] = {"rig", "retarget"};

void put(const std::filesystem::path& file, const std::string& text = "x") {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

BatchPlan planWith(const std::filesystem::path& folder, const std::string& inputs) {
  put(folder / "plan.json", R"({"limber_batch": 1, "command": ["rig", "{input}", "-o", "{output}"], "output": ".glb",
    "inputs": [)" + inputs + "]}");
  return readBatchPlan(folder / "plan.json", kCommands);
}

std::string problemOf(const std::filesystem::path& folder, const std::string& plan) {
  put(folder / "bad.json", plan);
  try {
    readBatchPlan(folder / "bad.json", kCommands);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

std::vector<std::string> outputsOf(const BatchPlan& plan) {
  std::vector<std::string> outputs;
  for (const BatchEntry& entry : plan.entries) outputs.push_back(entry.output);
  return outputs;
}

TEST(BatchPlan, FindsFoldersPatternsAndFiles) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"models/b.obj", "models/in/a.glb", "models/notes.md", "scans/one.ply", "alone.stl"}) {
    put(folder.path() / name);
  }
  const BatchPlan plan = planWith(folder.path(), R"("models", "scans/*.ply", "alone.stl")");
  EXPECT_THAT(outputsOf(plan), ElementsAre("models/b.glb", "models/in/a.glb", "scans/one.glb", "alone.glb"));
  EXPECT_EQ(plan.entries[1].input, "models/in/a.glb");
}

TEST(BatchPlan, IsReadInTheFolderThatItLiesIn) {
  const testing::TemporaryFolder folder;
  put(folder.path() / "models/a.glb");
  planWith(folder.path(), R"("models")");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const BatchPlan plan = readBatchPlan("plan.json", kCommands);
  std::filesystem::current_path(before);
  EXPECT_THAT(outputsOf(plan), ElementsAre("models/a.glb"));
}

TEST(BatchPlan, ReadsLists) {
  const testing::TemporaryFolder folder;
  const std::string digest(64, 'a');
  put(folder.path() / "lists/some.txt", "one.obj\r\n\n../up.obj\n");
  put(folder.path() / "more.jsonl", R"({"path": "two.obj", "sha256": ")" + digest + "\"}\n" +
                                        R"({"path": "three.obj", "options": ["--handles", "9"]})");
  const BatchPlan plan = planWith(folder.path(), R"("lists/some.txt", "more.jsonl", {"path": "four.obj"})");
  EXPECT_THAT(outputsOf(plan), ElementsAre("lists/one.glb", "up.glb", "two.glb", "three.glb", "four.glb"));
  EXPECT_EQ(plan.entries[2].sha256, digest);
  EXPECT_THAT(plan.entries[3].options, ElementsAre("--handles", "9"));
}

TEST(BatchPlan, ListsMayHaveCommentsAndAByteOrderMark) {
  const testing::TemporaryFolder folder;
  put(folder.path() / "some.txt", "\xef\xbb\xbfone.obj\n# two.obj\n three.obj\n");
  put(folder.path() / "more.jsonl", "\xef\xbb\xbf# four\n{\"path\": \"four.obj\"}");
  EXPECT_THAT(outputsOf(planWith(folder.path(), R"("some.txt", "more.jsonl")")),
              ElementsAre("one.glb", "three.glb", "four.glb"));
}

TEST(BatchPlan, RefusesNamesThatRecordsCannotTellApart) {
  const testing::TemporaryFolder folder;
  put(folder.path() / "m/x\xfe.obj");
  const std::string plan = R"({"limber_batch": 1, "command": ["rig", "{input}", "-o", "{output}"], "output": ".glb",
    "inputs": [")";
  for (const char* inputs : {"m", "m/*", "some.txt"}) {
    put(folder.path() / "some.txt", "m/x\xfe.obj");
    EXPECT_THAT(problemOf(folder.path(), plan + inputs + "\"]}"), HasSubstr(R"(the name 'm/x\xfe.obj' is not UTF-8)"));
  }
}

TEST(BatchPlan, NamesOutputsApart) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"m/a.obj", "m/a.stl", "m/b.obj"}) put(folder.path() / name);
  EXPECT_THAT(outputsOf(planWith(folder.path(), R"("m")")), ElementsAre("m/a_obj.glb", "m/a_stl.glb", "m/b.glb"));
}

TEST(BatchPlan, RefusesAnOutputThatWouldBeTheFolderOfAnother) {
  const testing::TemporaryFolder folder;
  for (const char* name : {"m/fish.obj", "m/fish.glb-old.obj", "m/fish.glb/deep/inner.obj"}) put(folder.path() / name);
  const std::string plan = R"({"limber_batch": 1, "command": ["rig", "{input}"], "output": ".glb", "inputs": ["m"]})";
  EXPECT_THAT(problemOf(folder.path(), plan), HasSubstr("the output 'm/fish.glb' would be the folder of another"));
  std::filesystem::remove(folder.path() / "m/fish.obj");
  EXPECT_EQ(problemOf(folder.path(), plan), "none");
}

TEST(BatchPlan, RefusesOutputsAmongTheBatchesRecords) {
  const testing::TemporaryFolder folder;
  for (const char* name : {".limber-batch/plan.glb", ".LIMBER-batch/records/1-of-1.glb", "m/.limber-batch/a.glb"}) {
    put(folder.path() / name);
    const std::string plan = R"({"limber_batch": 1, "command": ["rig", "{input}"], "output": ".json", "inputs": [")" +
                             std::string(name) + "\"]}";
    const bool isInside = name[0] == 'm';  // out/m/.limber-batch is no record
    EXPECT_THAT(problemOf(folder.path(), plan), HasSubstr(isInside ? "none" : "among the batch's records")) << name;
  }
}

TEST(BatchPlan, StaysInItsFolderOfOutputs) {
  const testing::TemporaryFolder folder;
  put(folder.path() / "in/plan.json");
  put(folder.path() / "out/a.obj");
  const BatchPlan plan =
      planWith(folder.path() / "in", R"("../out/a.obj", ")" + (folder.path() / "out/a.obj").string() + '"');
  EXPECT_EQ(plan.entries[0].output, "out/a.glb");
  EXPECT_FALSE(plan.entries[1].output.starts_with('/'));
  EXPECT_THAT(plan.entries[1].output, HasSubstr("out/a.glb"));
}

TEST(BatchPlan, LeavesOutWhatItHasWritten) {
  const testing::TemporaryFolder folder;
  for (const char* name :
       {"a.obj", "deep/b.obj", "deep/out/a.glb", "deep/out/.limber-batch/unfinished-1-of-1/0/a.glb"}) {
    put(folder.path() / name);
  }
  std::filesystem::create_directory_symlink(folder.path() / "deep/out", folder.path() / "results");
  const auto outputsFor = [&](const std::string& inputs) {
    planWith(folder.path(), inputs);
    return outputsOf(readBatchPlan(folder.path() / "plan.json", kCommands, folder.path() / "results"));
  };
  EXPECT_THAT(outputsFor(R"(".")"), ElementsAre("a.glb", "deep/b.glb"));
  EXPECT_THAT(outputsFor(R"("**/?.*")"), ElementsAre("a.glb", "deep/b.glb"));
  EXPECT_THAT(outputsFor(R"("deep/out/a.glb")"), ElementsAre("deep/out/a.glb"));  // named by itself
}

TEST(BatchPlan, RefusesWhatIsWrong) {
  const testing::TemporaryFolder folder;
  put(folder.path() / "a.obj");
  const auto plan = [](const std::string& command, const std::string& output, const std::string& inputs) {
    return R"({"limber_batch": 1, "command": )" + command + R"(, "output": ")" + output + R"(", "inputs": [)" + inputs +
           "]}";
  };
  const std::string rig = R"(["rig", "{input}", "-o", "{output}"])";
  EXPECT_EQ(problemOf(folder.path(), plan(rig, ".glb", R"("a.obj")")), "none");
  EXPECT_THAT(problemOf(folder.path(), "{}"), HasSubstr("limber_batch"));
  EXPECT_THAT(problemOf(folder.path(), plan(R"(["study", "{input}", "{output}"])", ".glb", R"("a.obj")")),
              HasSubstr("is no command of a batch; there are: rig, retarget"));
  EXPECT_EQ(problemOf(folder.path(), plan(R"(["rig", "{input}"])", ".json", R"("a.obj")")), "none");
  EXPECT_THAT(problemOf(folder.path(), plan(R"(["rig", "{output}"])", ".glb", R"("a.obj")")), HasSubstr("{input}"));
  EXPECT_THAT(problemOf(folder.path(), plan(R"(["rig", "{input}", "{output}", "{output}"])", ".glb", R"("a.obj")")),
              HasSubstr("{output}"));
  for (const char* several : {".gltf", ".GLTF", ".posed.Obj"}) {
    EXPECT_THAT(problemOf(folder.path(), plan(rig, several, R"("a.obj")")), HasSubstr("several files"));
  }
  EXPECT_THAT(problemOf(folder.path(), plan(rig, ".glb", R"("b.obj")")), HasSubstr("is not there"));
  EXPECT_THAT(problemOf(folder.path(), plan(rig, ".glb", R"("*.stl")")), HasSubstr("inputs[0]: matches no file"));
  EXPECT_THAT(problemOf(folder.path(), plan(rig, ".glb", R"("a.obj", "a.obj")")), HasSubstr("twice"));
  EXPECT_THAT(problemOf(folder.path(), plan(rig, ".glb", R"({"path": "a.obj", "hash": "1"})")), HasSubstr("hash"));
}

TEST(BatchPlan, ReadsShards) {
  EXPECT_EQ(parseBatchShard("3/16").number, 3u);
  EXPECT_EQ(parseBatchShard("3/16").count, 16u);
  for (const char* wrong : {"", "3", "0/2", "3/2", "1/", "a/b", "1/2/3", "-1/2"}) {
    EXPECT_THROW(parseBatchShard(wrong), Error) << wrong;
  }
}

}  // namespace
}  // namespace limber
