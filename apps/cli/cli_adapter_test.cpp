// limber rig, retarget and study with programs of the user's, run as a user runs them.
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "process_state.h"
#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// Two joints in the middle of whatever it is given.
constexpr std::string_view kTwoJoints =
    "test -s \"$1\" || exit 1\n"
    "printf 'joints low%s 0 -0.2 0\\nroot low%s\\nhier low%s high\\n' $3 $3 $3 > \"$2\"\n"
    "echo joints high 0 0.2 0 >> \"$2\"\n";
constexpr std::string_view kAdapter = R"({
  "limber_adapter": 1,
  "kind": "rig",
  "steps": [{"command": ["/bin/sh", "two.sh", "{input}", "{output}", "{seed}"], "folder": "."}]
})";

class CliAdapter : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    fs::create_directory(folder_ / "mine");
    put("mine/two.json", std::string(kAdapter));
    put("mine/two.sh", std::string(kTwoJoints));
    makeRobot();
  }
  void putFailing(const std::string& line) {
    put("mine/bad.json", R"({"limber_adapter": 1, "kind": "rig", "steps": [{"command": ["/bin/sh", "-c", ")" + line +
                             R"(", "sh", "{input}"]}]})");
  }
};

TEST_F(CliAdapter, AProgramRigsAndTheReportNamesIt) {
  const Result rig = run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "two", "--seed", "7", "-o",
                          "rigged.glb", "--json", "report.json"});
  ASSERT_EQ(rig.code, 0) << rig.error;
  EXPECT_THAT(rig.out, AllOf(HasSubstr("2 joints (two)"), HasSubstr("written: rigged.glb")));
  const auto report = nlohmann::json::parse(content("report.json"));
  EXPECT_EQ(report.at("methods").at("rigger"), "two");
  EXPECT_EQ(report.at("methods").at("skinning"), "bone-heat");
  const Result info = run({"info", "rigged.glb"});
  EXPECT_EQ(info.code, 0);
  EXPECT_THAT(content("rigged.glb"), AllOf(HasSubstr("\"low7\""), HasSubstr("\"high\"")));
  keep("rigged.glb");
}

TEST_F(CliAdapter, ANameThatNobodyHasIsAnErrorThatTellsWhereItWasLookedFor) {
  const Result rig = run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "three", "-o", "rigged.glb"});
  expectOneLine(rig, 1);
  EXPECT_THAT(rig.error, AllOf(HasSubstr("no rigger is called 'three'"), HasSubstr("sphere-mesh"), HasSubstr("two"),
                               HasSubstr("programs of yours are NAME.json in")));
  expectOneLine(run({"rig", "robot.glb", "--adapter-folder", "mine", "--skinning", "two", "-o", "rigged.glb"}), 1);
}

TEST_F(CliAdapter, ASeedIsAWholeNumberFrom0) {
  for (const std::string seed : {"-1", "0.5", "x", ""}) {
    expectOneLine(
        run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "two", "--seed=" + seed, "-o", "a.glb"}), 2);
  }
}

TEST_F(CliAdapter, AProgramThatFailsLeavesNothing) {
  putFailing("echo no checkpoint >&2; exit 3");
  const Result failed = run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "bad", "-o", "rigged.glb"});
  expectOneLine(failed, 1);
  EXPECT_THAT(failed.error, AllOf(HasSubstr("robot.glb: bad: step 1"), HasSubstr("no checkpoint")));
  putFailing("exit 0");
  expectOneLine(run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "bad", "-o", "rigged.glb"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "rigged.glb"));
}

// A program that gives back the weights that it is given shows which they were.
TEST_F(CliAdapter, AProgramIsHandedTheWeightsThatItTakes) {
  const auto putPassing = [&](const char* takes) {
    put("mine/passing.json", std::string(R"({"limber_adapter": 1, "kind": "weights", "input": {"weights": )") + takes +
                                 R"(}, "steps": [{"command": ["cp", "{input}", "{output}"]}]})");
  };
  const auto rigBy = [&](const char* skinning, const char* output) {
    const Result rig = run({"rig", "robot.glb", "--rigger", "sphere-mesh", "--handles", "9", "--adapter-folder", "mine",
                            "--skinning", skinning, "-o", output, "--quiet"});
    EXPECT_EQ(rig.code, 0) << rig.error;
  };
  const auto apart = [&](const char* one, const char* other) {
    const Result weights = run({"evaluate", "weights", one, other, "--json"});
    EXPECT_EQ(weights.code, 0) << weights.error;
    return nlohmann::json::parse(weights.out).at("l1").get<double>();
  };
  rigBy("bone-heat", "usual.glb");
  rigBy("nearest-bone", "nearest.glb");
  ASSERT_GT(apart("usual.glb", "nearest.glb"), 0.1);
  putPassing("true");
  rigBy("passing", "passed.glb");
  EXPECT_LT(apart("passed.glb", "usual.glb"), 0.01);
  putPassing("false");
  rigBy("passing", "passed.glb");
  EXPECT_LT(apart("passed.glb", "nearest.glb"), 0.01);
}

// Gives back the motion that it is given.
constexpr std::string_view kCopying = R"({
  "limber_adapter": 1,
  "kind": "retarget",
  "steps": [{"command": ["cp", "{motion}", "{output}"]}, {"command": ["test", "-s", "{skeleton}"]}],
  "input": {"metres_per_unit": 0.01}
})";

TEST_F(CliAdapter, AProgramRetargets) {
  put("mine/copying.json", std::string(kCopying));
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "--quiet"}).code, 0);
  const Result made =
      run({"retarget", "walk.bvh", "walk.bvh", "--adapter-folder", "mine", "--method", "copying", "-o", "moving.glb"});
  ASSERT_EQ(made.code, 0) << made.error;
  EXPECT_THAT(made.out, AllOf(HasSubstr("a second, by copying"), HasSubstr("written: moving.glb")));
  EXPECT_EQ(made.error, "");
  const Result judged = run({"evaluate", "motion", "moving.glb", "--source", "walk.bvh", "--json"});
  ASSERT_EQ(judged.code, 0) << judged.error;
  EXPECT_THAT(made.out, HasSubstr("walk_2"));  // a skeleton alone keeps its own clip, "walk"
  keep("moving.glb");
  const Result both = run({"retarget", "walk.bvh", "walk.bvh", "--adapter", "mine/copying.json", "--method", "copying",
                           "--solver", "fabrik", "-o", "both.glb"});
  expectOneLine(both, 2);
  EXPECT_THAT(both.error, HasSubstr("--solver: is for limber's own methods"));
  expectOneLine(run({"retarget", "walk.bvh", "walk.bvh", "--adapter-folder", "mine", "--method", "two", "-o", "a.glb"}),
                1);
  expectOneLine(run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "copying", "-o", "a.glb"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "a.glb"));
}

// A rigger that hangs, as does a child of it, in a cell of a study.
class HangingStudy : public CliAdapter {
 protected:
  void SetUp() override {
    CliAdapter::SetUp();
    const std::string pids = (folder_ / "pids").string();
    put("mine/hang.sh", "sleep 1000 & echo $PPID $$ $! > " + pids + ".part; mv " + pids + ".part " + pids + "; wait");
    put("mine/hang.json", R"({"limber_adapter": 1, "kind": "rig",
                              "steps": [{"command": ["/bin/sh", "hang.sh", "{input}"], "folder": "."}]})");
  }
  void putPlan(const std::string& seconds) {
    put("plan.json", R"({"limber_study": 1, "rig": {"models": ["robot.glb"], "riggers": ["hang"]},
                         "limits": {"seconds": )" +
                         seconds + "}}");
  }
  // limber rig, the program that it runs, and a child of that one; none where none has begun.
  std::vector<pid_t> hanging() const {
    std::vector<pid_t> pids(3, 0);
    std::ifstream file(folder_ / "pids");
    for (pid_t& pid : pids) file >> pid;
    return pids;
  }
};

TEST_F(HangingStudy, NothingLivesAfterTheCellsTime) {
  putPlan("1");
  const Result study = run({"study", "plan.json", "--adapter-folder", "mine", "-o", "report"});
  EXPECT_EQ(study.code, 0) << study.error;
  EXPECT_THAT(content("report/cells.csv"), HasSubstr("timed-out"));
  for (const pid_t pid : hanging()) EXPECT_TRUE(pid == 0 || testing::endsSoon(pid)) << pid;
}

TEST_F(HangingStudy, NothingLivesAfterAStudyThatIsKilled) {
  putPlan("1000");
  Running study({"study", "plan.json", "--adapter-folder", "mine", "-o", "report", "--quiet"}, folder_);
  for (int i = 0; i < 4000 && !fs::exists(folder_ / "pids"); ++i) usleep(5000);
  study.signal(SIGKILL);
  EXPECT_EQ(study.waitWithOpenInput().code, 128 + SIGKILL);
  for (const pid_t pid : hanging()) {
    ASSERT_GT(pid, 0);
    EXPECT_TRUE(testing::endsSoon(pid)) << pid;
  }
}

}  // namespace
}  // namespace limber
