// limber rig with programs of the user's, run as a user runs it.
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

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

TEST_F(CliAdapter, AProgramThatFailsLeavesNothing) {
  putFailing("echo no checkpoint >&2; exit 3");
  const Result failed = run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "bad", "-o", "rigged.glb"});
  expectOneLine(failed, 1);
  EXPECT_THAT(failed.error, AllOf(HasSubstr("robot.glb: bad: step 1"), HasSubstr("no checkpoint")));
  putFailing("exit 0");
  expectOneLine(run({"rig", "robot.glb", "--adapter-folder", "mine", "--rigger", "bad", "-o", "rigged.glb"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "rigged.glb"));
}

}  // namespace
}  // namespace limber
