// limber batch, run as a user runs it.
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

std::string batchPlan(const std::string& inputs,
                      const std::string& command = R"("convert", "{input}", "-o", "{output}")",
                      const std::string& output = ".glb") {
  return R"({"limber_batch": 1, "command": [)" + command + R"(], "output": ")" + output + R"(", "inputs": [)" + inputs +
         "]}";
}

TEST_F(Cli, ABatchTellsByItsCodeWhoseFaultItIs) {
  makeRobot();
  put("plan.json", batchPlan(R"("robot.glb")"));
  EXPECT_EQ(run({"batch", "plan.json", "-o", "out", "--quiet"}).code, 0);
  put("failing.json", batchPlan(R"("robot.glb", {"path": "none.glb"})"));
  expectOneLine(run({"batch", "failing.json", "-o", "failing", "--quiet"}), 1);
  put("wrong.json", batchPlan(R"("none.glb")"));
  expectOneLine(run({"batch", "wrong.json", "-o", "wrong"}), 2);
  expectOneLine(run({"batch", "none.json", "-o", "wrong"}), 2);
  expectOneLine(run({"batch", "plan.json", "-o", "out", "--shard", "3/2"}), 2);
  put("a_file", "mine");
  expectOneLine(run({"batch", "plan.json", "-o", "a_file"}), 2);
  fs::create_directory(folder_ / "foreign");
  put("foreign/diary.txt", "mine");
  expectOneLine(run({"batch", "plan.json", "-o", "foreign"}), 2);
}

TEST_F(Cli, ABatchEndsWhereNothingCanBeWritten) {
  if (!fs::exists("/proc/self")) GTEST_SKIP() << "there is no /proc here";
  makeRobot();
  put("plan.json", batchPlan(R"("robot.glb")"));
  expectOneLine(run({"batch", "plan.json", "-o", "/proc/limber_out", "--quiet"}), 4);
}

TEST_F(Cli, EachCommandThatABatchMayRunRunsInOne) {
  ASSERT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);
  ASSERT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"}).code, 0);
  const std::string help = run({"batch", "--help"}).out;
  struct Case {
    std::string command, arguments, output = ".glb";
  };
  for (const Case& one : std::vector<Case>{
           {"rig", R"("{input}", "-o", "{output}", "--replace-rig")"},
           {"animate", R"("{input}", "walk.bvh", "-o", "{output}")"},
           {"retarget", R"("{input}", "walk.bvh", "-o", "{output}")"},
           {"convert", R"("{input}", "-o", "{output}")"},
           {"preview", R"("{input}", "-o", "{output}", "--size", "64x64")", ".png"},
           {"pose", R"("{input}", "-o", "{output}")"},
           {"transfer", R"("hero.glb", "{input}", "-o", "{output}")"},
           {"evaluate", R"("weights", "{input}", "hero.glb", "--json")", ".json"},
           {"evaluate", R"("rig", "{input}", "hero.glb", "--json")", ".json"},
           {"evaluate", R"("model", "{input}", "--json")", ".json"},
           {"info", R"("{input}", "--json")", ".json"},
       }) {
    EXPECT_THAT(help, HasSubstr(one.command));
    put("plan.json", batchPlan(R"("hero.glb")", '"' + one.command + "\", " + one.arguments, one.output));
    const Result result = run({"batch", "plan.json", "-o", "out", "-q"});
    EXPECT_EQ(result.code, 0) << one.command << ": " << result.error << run({"batch", "status", "out"}).out;
    EXPECT_TRUE(one.output != ".json" || nlohmann::json::accept(content("out/hero.json"))) << one.command;
  }
}

TEST_F(Cli, AnEntrysOptionsCountInPlaceOfThoseOfTheCommand) {
  makeRobot();
  const std::string rig = R"("rig", "{input}", "-o", "{output}", "--handles", "5")";
  put("plan.json", batchPlan(R"({"path": "robot.glb", "options": ["--handles", "9"]})", rig));
  EXPECT_EQ(run({"batch", "plan.json", "-o", "out", "-q"}).code, 0);
  EXPECT_EQ(nlohmann::json::parse(run({"info", "out/robot.glb", "--json"}).out).at("joints"), 9);
}

TEST_F(Cli, ACommandThatMakesNoSenseIsRefusedBeforeTheFirstEntry) {
  makeRobot();
  for (const char* command : {R"("rig", "{input}", "-o", "{output}", "--handels", "5")",
                              R"("rig", "{input}", "-o", "mine.glb")", R"("info", "{input}", "-o", "{output}")",
                              R"("evaluate", "{input}")", R"("rig", "{input}", "{output}", "-h")"}) {
    put("plan.json", batchPlan(R"("robot.glb")", command));
    const Result result = run({"batch", "plan.json", "-o", "out"});
    expectOneLine(result, 2);
    EXPECT_THAT(result.error, HasSubstr("plan.json: command: "));
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  put("plan.json", batchPlan(R"({"path": "robot.glb", "options": ["robot.glb"]})",
                             R"("evaluate", "weights", "{input}")"));  // makes sense with what the entry adds
  EXPECT_EQ(run({"batch", "plan.json", "-o", "out", "-q"}).code, 1);
  put("plan.json", batchPlan(R"({"path": "robot.glb", "options": ["--handels", "9"]})"));
  EXPECT_EQ(run({"batch", "plan.json", "-o", "out", "-q"}).code, 1);  // of an entry's own
}

TEST_F(Cli, WhatAnEntryAddsIsThatEntrysMatterWhereverItStands) {
  makeRobot();
  const std::string bytes = content("robot.glb");
  fs::copy(folder_ / "robot.glb", folder_ / "second.glb");
  const std::string good = R"({"path": "second.glb", "options": ["5"]})";
  int folders = 0;
  for (const std::string bad : {R"("robot.glb")", R"({"path": "robot.glb", "options": ["x"]})",
                                R"({"path": "robot.glb", "options": ["5", "-o", "second.glb"]})",
                                R"({"path": "robot.glb", "options": ["5", "--help"]})"}) {
    for (const std::string& entries : {bad + ", " + good, good + ", " + bad}) {
      put("plan.json", batchPlan(entries, R"("rig", "{input}", "-o", "{output}", "--handles")"));
      const std::string out = "out" + std::to_string(folders++);
      EXPECT_EQ(run({"batch", "plan.json", "-o", out, "-q"}).code, 1) << entries;
      EXPECT_THAT(run({"batch", "status", out}).out, HasSubstr("1 done, 1 failed, 0 open")) << entries;
    }
  }
  EXPECT_EQ(content("second.glb"), bytes);
}

// Of options in the command, or in an entry.
struct PlanWords {
  std::string words;
  bool isOfEntry;
};
std::vector<PlanWords> inBothPositions(const std::vector<std::string>& each) {
  std::vector<PlanWords> all;
  for (const std::string& words : each) {
    all.push_back({words, false});
    all.push_back({words, true});
  }
  return all;
}

std::string rigPlan(const PlanWords& words) {
  const std::string rig = R"("rig", "{input}", "-o", "{output}")";
  return words.isOfEntry ? batchPlan(R"({"path": "robot.glb", "options": [)" + words.words + "]}", rig)
                         : batchPlan(R"("robot.glb")", rig + ", " + words.words);
}

TEST_F(Cli, APlanOfABatchRunsNoProgram) {
  makeRobot();
  put("a.json",
      R"({"limber_adapter": 1, "kind": "rig", "steps": [{"command": ["/bin/sh", "-c", "touch ran", "{input}"], "folder": "."}]})");
  int folders = 0;
  for (const PlanWords& words :
       inBothPositions({R"("--rigger", "a", "--adapter", "a.json")", R"("--rigger", "a", "--adapter=a.json")",
                        R"("--rigger", "a", "--adapter-folder", ".")", R"("--rigger", "a", "--adapter-folder=.")"})) {
    put("plan.json", rigPlan(words));
    const std::string out = "out" + std::to_string(folders++);
    EXPECT_EQ(run({"batch", "plan.json", "-o", out, "-q"}).code, words.isOfEntry ? 1 : 2) << words.words;
    EXPECT_FALSE(fs::exists(folder_ / "ran")) << words.words;
  }
  // The user says where programs are, the plan which.
  put("plan.json", rigPlan({R"("--rigger", "a")", false}));
  run({"batch", "plan.json", "-o", "mine", "-q", "--adapter-folder", "."});
  EXPECT_TRUE(fs::exists(folder_ / "ran"));
}

TEST_F(Cli, APlanOfABatchWritesNothingButOutputs) {
  makeRobot();
  put("kept", "mine");
  int folders = 0;
  for (const PlanWords& words : inBothPositions({R"("--json", "kept")", R"("--json=kept")", R"("-o", "kept")"})) {
    put("plan.json", rigPlan(words));
    const std::string out = "out" + std::to_string(folders++);
    EXPECT_EQ(run({"batch", "plan.json", "-o", out, "-q"}).code, words.isOfEntry ? 1 : 2) << words.words;
    EXPECT_EQ(content("kept"), "mine") << words.words;
  }
  for (const char* command : {R"("rig", "{input}", "-o", "kept.glb", "--vrm-name", "{output}")",
                              R"("retarget", "{input}", "robot.glb", "-o", "{output}", "--save-map", "kept")",
                              R"("transfer", "robot.glb", "{input}", "-o", "{output}", "--report", "kept")",
                              R"("evaluate", "templates", "{input}", "-o", "{output}", "--sheet", "kept.png")"}) {
    put("plan.json", batchPlan(R"("robot.glb")", command));
    expectOneLine(run({"batch", "plan.json", "-o", "out"}), 2);
  }
}

TEST_F(Cli, ABatchBelowItsInputsHasTheSameEntriesAgain) {
  makeRobot();
  put("plan.json", batchPlan(R"(".")"));
  for (const char* message : {"1 entry: 1 run", "1 entry: 0 run"}) {
    const Result result = run({"batch", "plan.json", "-o", "out"});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_THAT(result.out, HasSubstr(message));
  }
}

}  // namespace
}  // namespace limber
