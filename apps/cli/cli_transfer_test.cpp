// limber transfer, as a user runs it.
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class Transfer : public Cli {
 protected:
  // A person without a rig.
  void makeBare() { ASSERT_EQ(run({"sample", "biped", "-o", "bare.glb", "-q"}).code, 0); }
  // A winged creature with an artist's rig, whose own joints tell where its limbs are.
  void makeFlying() { ASSERT_EQ(run({"sample", "flying", "-o", "flying.glb", "-q"}).code, 0); }
  nlohmann::json infoOf(const std::string& name) { return nlohmann::json::parse(run({"info", name, "--json"}).out); }
};

TEST_F(Transfer, PutsARigOntoABareBodyAndReportsIt) {
  makeBare();
  ASSERT_EQ(run({"rig", "bare.glb", "--rigger", "template", "-o", "hero.glb", "-q"}).code, 0);
  const Result result = run({"transfer", "hero.glb", "bare.glb", "-o", "out.glb", "--report", "report.json"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, AllOf(HasSubstr("landmarks"), HasSubstr("surfaces apart"), HasSubstr("written: out.glb")));
  const auto report = nlohmann::json::parse(content("report.json"));
  EXPECT_EQ(report.at("command"), "transfer");
  EXPECT_EQ(report.at("counts").at("joints"), infoOf("hero.glb").at("joints"));
  EXPECT_LT(report.at("gaps").at("rms").get<double>(), 0.5) << "it is the same body";
  double seconds = 0;
  bool hasSteps = false;
  for (const auto& stage : report.at("stages")) {
    seconds += stage.at("seconds").get<double>();
    hasSteps = hasSteps || stage.contains("steps");
  }
  EXPECT_TRUE(hasSteps);
  EXPECT_NEAR(report.at("seconds").get<double>(), seconds, 1e-9);
  const auto made = infoOf("out.glb");
  EXPECT_EQ(made.at("joints"), infoOf("hero.glb").at("joints"));
  EXPECT_EQ(made.at("weights").at("without_weights"), 0);
  keep("out.glb");
}

TEST_F(Transfer, ColorsGoOverWhereTheyAreAskedFor) {
  makeFlying();
  ASSERT_EQ(run({"transfer", "flying.glb", "flying.glb", "-o", "plain.glb", "-q"}).code, 0);
  const Result painted = run({"transfer", "flying.glb", "flying.glb", "--colors", "-o", "painted.glb", "-q"});
  EXPECT_EQ(painted.code, 0) << painted.error;
  EXPECT_THAT(content("plain.glb"), Not(HasSubstr("COLOR_0")));
  EXPECT_THAT(content("painted.glb"), HasSubstr("COLOR_0"));
  EXPECT_EQ(run({"transfer", "flying.glb", "flying.glb", "--colors", "-o", "again.glb", "-q"}).code, 0);
  EXPECT_EQ(content("again.glb"), content("painted.glb"));
  keep("painted.glb");
}

TEST_F(Transfer, WhatCannotBeServedIsOneLineAndLeavesNoFile) {
  makeBare();
  makeFlying();
  ASSERT_EQ(run({"sample", "stool", "-o", "stool.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"rig", "stool.glb", "--handles", "9", "-o", "handles.glb", "-q"}).code, 0);
  put("cut.npz", "PK\3\4cut");
  const std::vector<std::string> before = files();
  const auto refused = [&](const std::string& source, const std::string& target) {
    const Result result = run({"transfer", source, target, "-o", "out.glb", "--report", "report.json"});
    expectOneLine(result, 1);
    EXPECT_THAT(result.error, Not(HasSubstr("motion")));
    return result.error;
  };
  EXPECT_THAT(refused("bare.glb", "flying.glb"), HasSubstr("bare.glb: has no rig to transfer"));
  EXPECT_THAT(refused("flying.glb", "stool.glb"), HasSubstr("stool.glb: "));
  EXPECT_THAT(refused("handles.glb", "flying.glb"), HasSubstr("flying.glb: the rig of "));
  EXPECT_THAT(refused("cut.npz", "bare.glb"), HasSubstr("cut.npz"));
  EXPECT_THAT(refused("none.glb", "bare.glb"), HasSubstr("none.glb"));
  expectOneLine(run({"transfer", "flying.glb", "-o", "out.glb"}), 2);
  expectOneLine(run({"transfer", "flying.glb", "bare.glb", "-o", "out.txt"}), 1);
  expectOneLine(run({"transfer", "flying.glb", "bare.glb", "-o", "out.glb", "--max-influences", "9"}), 2);
  EXPECT_EQ(files(), before);
}

TEST_F(Transfer, InterruptedAtWorkItLeavesNoFile) {
  makeBare();
  makeFlying();
  const std::vector<std::string> before = files();
  Running running({"transfer", "flying.glb", "bare.glb", "-o", "out.glb", "--report", "report.json"}, folder_);
  std::this_thread::sleep_for(std::chrono::milliseconds(150));
  running.signal(SIGINT);
  expectOneLine(running.wait(), 130);
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace limber
