// limber rig --from-animation, and its evaluation, as a user runs them.
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class AnimationRig : public Cli {
 protected:
  void makeFlying() { ASSERT_EQ(run({"sample", "flying", "-o", "flying.glb", "--quiet"}).code, 0); }
};

TEST_F(AnimationRig, FindsTheBonesOfAClip) {
  makeFlying();
  const Result result = run({"rig", "--from-animation", "flying.glb", "--bones", "12", "--fps", "10", "-o", "out.glb",
                             "--json", "report.json"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, AllOf(HasSubstr("12 bones"), HasSubstr("% of the diagonal"), HasSubstr("out.glb")));
  const auto report = nlohmann::json::parse(content("report.json"));
  EXPECT_EQ(report.at("counts").at("joints"), 12);
  EXPECT_EQ(report.at("methods").at("rigger"), "animation");
  EXPECT_LT(report.at("error_percent").get<double>(), 1);
  const auto info = nlohmann::json::parse(run({"info", "out.glb", "--json"}).out);
  EXPECT_EQ(info.at("joints"), 12);
  EXPECT_EQ(info.at("weights").at("without_weights"), 0);
  EXPECT_LE(info.at("weights").at("most_influences"), 4);
  EXPECT_EQ(info.at("clips").size(), report.at("counts").at("clips"));
  keep("out.glb");
}

TEST_F(AnimationRig, WhatCannotBeServedIsOneLineAndLeavesNoFile) {
  makeRobot();
  put("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  put("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n");
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& frames : std::vector<std::vector<std::string>>{
           {"robot.glb"}, {"a.obj"}, {"a.obj", "a.obj"}, {"a.obj", "b.obj"}, {"a.obj", "robot.glb"}, {"none.glb"}}) {
    std::vector<std::string> arguments = {"rig", "-o", "out.glb", "--from-animation"};
    arguments.insert(arguments.end(), frames.begin(), frames.end());
    expectOneLine(run(arguments), 1);
  }
  expectOneLine(run({"rig", "robot.glb", "--from-animation", "a.obj", "-o", "out.glb"}), 2);
  expectOneLine(run({"rig", "robot.glb", "--bones", "4", "-o", "out.glb"}), 2);
  expectOneLine(run({"rig", "-o", "out.glb"}), 2);
  EXPECT_EQ(files(), before);
}

TEST_F(AnimationRig, OfObjFilesIsEvaluatedOverAFolder) {
  fs::create_directory(folder_ / "models");
  // Two triangles, the second of which rotates upwards about their common edge.
  for (const auto& [name, corner] :
       {std::pair{"f1.obj", "1 1 0"}, {"f2.obj", "0.9 0.9 0.3"}, {"f3.obj", "0.7 0.7 0.4"}}) {
    put(name, std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nv ") + corner + "\nf 1 2 3\nf 2 4 3\n");
  }
  const Result rigged =
      run({"rig", "--from-animation", "f1.obj", "f2.obj", "f3.obj", "--bones", "2", "-o", "models/fold.glb"});
  EXPECT_EQ(rigged.code, 0) << rigged.error;
  EXPECT_THAT(rigged.out, HasSubstr("3 frames of 1 clip"));
  const Result result = run({"evaluate", "decomposition", "models", "--each", "each.tsv", "--quiet"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, AllOf(HasSubstr("within 0.3 %"), HasSubstr("| models | 1 |")));
  EXPECT_THAT(content("each.tsv"), HasSubstr("models\tfold\tf\t"));
  fs::remove(folder_ / "each.tsv");
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& outputs : std::vector<std::vector<std::string>>{
           {"--each", "same.tsv", "-o", "same.tsv"},  // not even a table
           {"--each", "./-", "-o", "table.md"},
           {"--each", "each.txt", "-o", "table.md"},
           {"--each", "each.tsv", "-o", "missing/table.md"},
       }) {
    std::vector<std::string> arguments = {"evaluate", "decomposition", "models", "--quiet"};
    arguments.insert(arguments.end(), outputs.begin(), outputs.end());
    EXPECT_EQ(run(arguments).code, 1) << outputs[1];
    EXPECT_EQ(files(), before) << outputs[1];
  }
  // The flat fold has no curve skeleton: that is said, and no rigger's means count it.
  ASSERT_EQ(run({"sample", "robot", "-o", "robot.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "models/robot.glb"}).code, 0);
  const Result riggers = run({"evaluate", "templates", "models/fold.glb", "models/robot.glb", "--rigger", "prop",
                              "--rigger", "curve-skeleton"});
  EXPECT_EQ(riggers.code, 0) << riggers.error;
  EXPECT_THAT(riggers.error, AllOf(HasSubstr("[not-rigged]"), HasSubstr("curve-skeleton: ")));
  EXPECT_THAT(riggers.out, AllOf(HasSubstr("| models (1) | prop |"), HasSubstr("| models (1) | curve-skeleton |")));
}

}  // namespace
}  // namespace limber
