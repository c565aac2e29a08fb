// The program itself, run as a user runs it.
#include <poll.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "limber/core/sanitizers.h"
#include "limber/document/testing/gltf_builder.h"
#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST_F(Cli, EveryCommandHasHelpWithAnExample) {
  EXPECT_THAT(run({"--help"}).out,
              AllOf(HasSubstr("rig"), HasSubstr("info"), HasSubstr("preview"), HasSubstr("sample")));
  for (const char* command : {"rig", "info", "preview", "sample", "evaluate", "convert", "parts", "pose", "session",
                              "retarget", "animate", "transfer", "studio", "study", "completion"}) {
    const Result help = run({command, "--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, AllOf(HasSubstr("Example"), HasSubstr(std::string("limber ") + command)));
  }
  EXPECT_THAT(run({"rig", "--help"}).out, AllOf(HasSubstr("sphere-mesh"), HasSubstr("bone-heat"), HasSubstr("Thiery")));
  EXPECT_THAT(run({"--version"}).out, StartsWith("limber "));
}

TEST_F(Cli, WrongUsageIsOneLineAndCodeTwo) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"fly"},
                                             {"rig"},
                                             {"rig", "a.glb"},
                                             {"rig", "a.glb", "-o", "b.glb", "--handles", "0"},
                                             {"rig", "a.glb", "-o", "b.glb", "--max-influences", "9"},
                                             {"rig", "a.glb", "-o", "b.glb", "--handles", "many"},
                                             {"rig", "a.glb", "-o", "b.glb", "--keep-skeleton", "--replace-rig"},
                                             {"rig", "a.glb", "-o", "b.glb", "--keep-skeleton", "--handles", "3"},
                                             {"rig", "a.glb", "-o", "-", "--json", "-"},
                                             {"rig", "a.glb", "-o", "b.glb", "--json", "b.glb"},
                                             {"rig", "a.glb", "-o", "b.glb", "--json", "./b.glb"},
                                             {"rig", "a.glb", "-o", "b.glb", "--json", "a.glb"},
                                             {"rig", "a.glb", "-o", "b.glb", "--pin", "head=0,1,0"},
                                             {"rig", "a.glb", "-o", "b.glb", "--up", "+z"},
                                             {"rig", "a.glb", "-o", "b.glb", "--keep-skeleton", "--front", "+z"},
                                             {"rig", "a.glb", "-o", "b.glb", "--template", "auto", "--handles", "5"},
                                             {"rig", "a.glb", "-o", "b.glb", "--template", "auto", "--rigger", "prop"},
                                             {"rig", "a.glb", "-o", "b.glb", "--keep-skeleton", "--template", "auto"},
                                             {"rig", "a.glb", "-o", "b.glb", "--template", "auto", "--up", "+w"},
                                             {"rig", "a.glb", "-o", "b.glb", "--template", "nobody"},
                                             {"rig", "a.glb", "-o", "b.glb", "--template", "no.bvh", "--handles", "5"},
                                             {"rig", "a.glb", "-o", "b.glb", "--pieces", "nobody"},
                                             {"rig", "a.glb", "-o", "b.glb", "--reading", "own.lrd"},
                                             {"retarget", "a.glb", "b.bvh", "-o", "c.glb", "--save-map", "b.bvh"},
                                             {"retarget", "a.glb", "b.bvh", "-o", "c.glb", "--save-map", "./a.glb"},
                                             {"retarget", "a.glb", "b.bvh", "-o", "c.glb", "--reach", "nan"},
                                             {"retarget", "a.glb", "b.bvh", "-o", "c.glb", "--ground", "nan"},
                                             {"pose", "a.glb", "-o", "b.glb", "--time", "nan"},
                                             {"preview", "a.glb", "-o", "b.png", "--time", "-1"},
                                             {"pose", "a.glb", "-o", "b.glb", "--deformer", "linear-blend"},
                                             {"info"},
                                             {"info", "a.glb", "--up", "+z"},
                                             {"info", "a.glb", "--rig-check", "--up", "+w"},
                                             {"info", "--conventions", "--rig-check"},
                                             {"sample", "stool"}}) {
    expectOneLine(run(arguments), 2);
  }
}

TEST_F(Cli, OptionsAreToldByTheirNamesHere) {
  EXPECT_THAT(run({"rig", "a.glb", "-o", "b.glb", "--pin", "head=0,1,0"}).error,
              StartsWith("limber: --pin: takes a template to fit (name one: --template auto)"));
  EXPECT_THAT(run({"rig", "a.glb", "-o", "b.glb", "--keep-skeleton", "--handles", "3"}).error,
              AllOf(StartsWith("limber: --handles: "), HasSubstr("leave --keep-skeleton out")));
  EXPECT_THAT(run({"rig", "a.glb", "-o", "b.glb", "--max-influences", "9"}).error,
              StartsWith("limber: --max-influences: takes 1 to 8, not 9"));
  EXPECT_THAT(run({"info", "`up`.glb"}).error, StartsWith("limber: `up`.glb: "));  // a file, no option
}

TEST_F(Cli, BadNetworksAreRefusedByTheirFile) {
  makeRobot();
  put("text.lrd", "no networks");
  put("cut.lrd", "LRD1");
  for (const auto& [file, message] :
       {std::pair("missing.lrd", "cannot be opened"), std::pair("text.lrd", "weights of a reading"),
        std::pair("cut.lrd", "weights of a reading")}) {
    const Result refused = run({"rig", "robot.glb", "-o", "b.glb", "--template", "humanoid", "--reading", file});
    expectOneLine(refused, 1);
    EXPECT_THAT(refused.error, AllOf(StartsWith("limber: " + std::string(file)), HasSubstr(message)));
  }
  EXPECT_FALSE(fs::exists(folder_ / "b.glb"));
}

TEST_F(Cli, ValuesOfRigAreNeverEmpty) {
  makeRobot();
  for (const char* option : {"--handles", "--max-influences", "--rigger", "--template", "--pin", "--up", "--front",
                             "--reading", "--skinning", "--pieces", "--json", "--from-animation"}) {
    const Result refused = run({"rig", "robot.glb", "-o", "b.glb", option, ""});
    expectOneLine(refused, 2);
    EXPECT_THAT(refused.error, AllOf(StartsWith("limber: " + std::string(option)), HasSubstr("is empty")));
  }
  EXPECT_EQ(files(), std::vector<std::string>{"robot.glb"});
}

TEST_F(Cli, RigsAModelAndAccountsForIt) {
  makeRobot();
  const Result result = run({"rig", "robot.glb", "--handles", "16", "-o", "out.glb", "--json", "report.json"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(result.error, "");  // no progress in a pipe
  EXPECT_THAT(result.out, AllOf(HasSubstr("weld"), HasSubstr("16 joints"), HasSubstr("total"), HasSubstr("out.glb")));

  const auto report = nlohmann::json::parse(content("report.json"));
  EXPECT_EQ(report.at("counts").at("pieces"), 23);
  EXPECT_GE(report.at("counts").at("joints"), 16);
  EXPECT_LE(report.at("counts").at("joints"), 17);  // one more as the root of loose pieces
  EXPECT_EQ(report.at("methods").at("rigger"), "sphere-mesh");
  EXPECT_FALSE(report.at("stages").empty());
  double sum = 0;
  std::vector<std::string> stages;
  for (const auto& stage : report.at("stages")) {
    sum += stage.at("seconds").get<double>();
    stages.push_back(stage.at("name").get<std::string>());
    double steps = 0;
    for (const auto& step : stage.value("steps", nlohmann::json::array())) steps += step.at("seconds").get<double>();
    EXPECT_LE(steps, stage.at("seconds").get<double>() + 1e-9) << stages.back();
  }
  EXPECT_NEAR(report.at("seconds").get<double>(), sum, 1e-9);
  EXPECT_EQ(stages, (std::vector<std::string>{"read", "read geometry", "weld", "rig", "skin", "write rig"}));

  const auto info = nlohmann::json::parse(run({"info", "out.glb", "--json"}).out);
  EXPECT_EQ(info.at("joints"), report.at("counts").at("joints"));
  EXPECT_EQ(info.at("weights").at("without_weights"), 0);
  EXPECT_LT(info.at("weights").at("largest_sum_error").get<double>(), 1e-5);
  EXPECT_LE(info.at("weights").at("most_influences"), 4);
  keep("out.glb");
}

TEST_F(Cli, QuietIsQuiet) {
  makeRobot();
  const Result result = run({"rig", "robot.glb", "-q", "-o", "out.glb"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out + result.error, "");
}

TEST_F(Cli, StandardInputAndOutputCarryTheSameBytesAsFiles) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "out.glb"}).code, 0);
  const Result piped = run({"rig", "-", "--handles", "9", "-o", "-"}, content("robot.glb"));
  EXPECT_EQ(piped.code, 0);
  EXPECT_TRUE(piped.out == content("out.glb"));
  EXPECT_THAT(piped.error, HasSubstr("total"));  // standard output has the file, so the report goes here
}

TEST_F(Cli, WritesGltfWithItsBuffer) {
  makeRobot();
  EXPECT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "out.gltf"}).code, 0);
  EXPECT_EQ(nlohmann::json::parse(run({"info", "out.gltf", "--json"}).out).at("format"), "gltf");
  EXPECT_GT(files().size(), 2u);
}

TEST_F(Cli, TheInputMayBeReplaced) {
  makeRobot();
  EXPECT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "robot.glb"}).code, 0);
  EXPECT_GE(nlohmann::json::parse(run({"info", "robot.glb", "--json"}).out).at("joints"), 9);
  EXPECT_EQ(files(), std::vector<std::string>{"robot.glb"});
}

TEST_F(Cli, ARiggedModelIsRefusedWithBothWaysOut) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "rigged.glb"}).code, 0);
  const Result refused = run({"rig", "rigged.glb", "-o", "again.glb"});
  expectOneLine(refused, 1);
  EXPECT_THAT(refused.error, AllOf(HasSubstr("--replace-rig"), HasSubstr("--keep-skeleton"), HasSubstr("rigged.glb")));
  EXPECT_FALSE(fs::exists(folder_ / "again.glb"));

  EXPECT_EQ(run({"rig", "rigged.glb", "--replace-rig", "--handles", "6", "-q", "-o", "replaced.glb"}).code, 0);
  EXPECT_LE(nlohmann::json::parse(run({"info", "replaced.glb", "--json"}).out).at("joints"), 7);
  EXPECT_EQ(run({"rig", "rigged.glb", "--keep-skeleton", "-q", "-o", "kept.glb"}).code, 0);
  const auto names = [&](const char* file) {
    return nlohmann::json::parse(run({"info", file, "--json"}).out).at("joint_names");
  };
  EXPECT_EQ(names("kept.glb"), names("rigged.glb"));
}

TEST_F(Cli, InfoSaysWhetherAModelCanBeRigged) {
  ASSERT_EQ(run({"sample", "biped", "-o", "person.glb", "-q"}).code, 0);
  const Result lines = run({"info", "person.glb", "--rig-check"});
  EXPECT_EQ(lines.code, 0) << lines.error;
  EXPECT_THAT(lines.out, AllOf(HasSubstr("\nrig check       humanoid"), HasSubstr("arms lowered (A pose)")));
  const auto json = nlohmann::json::parse(run({"info", "person.glb", "--rig-check", "--up", "+y", "--json"}).out);
  EXPECT_EQ(json.at("pieces"), 1);
  EXPECT_EQ(json.at("rig_check").at("pose"), "A");
  EXPECT_FALSE(json.at("rig_check").at("has_rig"));
  EXPECT_FALSE(nlohmann::json::parse(run({"info", "person.glb", "--json"}).out).contains("rig_check"));

  ASSERT_EQ(run({"rig", "person.glb", "--handles", "5", "-o", "rigged.glb", "-q"}).code, 0);
  EXPECT_THAT(run({"info", "rigged.glb", "--rig-check"}).out,
              AllOf(HasSubstr("--replace-rig"), HasSubstr("[has-rig]")));
}

TEST_F(Cli, RigBeginsWithWhatTheModelIs) {
  ASSERT_EQ(run({"sample", "biped", "-o", "person.glb", "-q"}).code, 0);
  const std::vector<std::string> rig = {"rig", "person.glb", "--template", "auto"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), rig.begin(), rig.end());
    return run(more);
  };
  EXPECT_THAT(with({"-o", "out.glb"}).out, StartsWith("humanoid"));
  EXPECT_EQ(with({"-o", "out.glb", "-q"}).out, "");
  const Result piped = with({"-o", "-"});
  EXPECT_THAT(piped.out, StartsWith("glTF"));
  EXPECT_THAT(piped.error, StartsWith("humanoid"));
  const Result report = with({"-o", "out.glb", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(report.out).at("command"), "rig");
  EXPECT_THAT(report.error, StartsWith("humanoid"));
  EXPECT_THAT(run({"rig", "person.glb", "--template", "humanoid", "-o", "out.glb"}).out, StartsWith("read"));
}

// The numbers of a T-pose, on a model in A-pose.
TEST_F(Cli, APinOutsideTheSurfaceIsReported) {
  ASSERT_EQ(run({"sample", "biped", "-o", "person.glb", "-q"}).code, 0);
  const Result wrong = run({"rig", "person.glb", "--template", "humanoid", "--pin", "leftHand=0.71,1.43,0.02", "--pin",
                            "head=0,1.48,-0.03", "-o", "wrong.glb"});
  EXPECT_EQ(wrong.code, 0) << wrong.error;
  EXPECT_THAT(wrong.error,
              ContainsRegex("warning: pin leftHand is 0\\.3[0-9]* m outside the surface \\[pins-outside\\]"));
  const Result right = run({"rig", "person.glb", "--template", "humanoid", "--pin", "leftHand=0.55,1.04,0", "--pin",
                            "head=0,1.48,-0.03", "-o", "right.glb"});
  EXPECT_EQ(right.code, 0) << right.error;
  EXPECT_THAT(right.error, Not(HasSubstr("pins-outside")));
}

TEST_F(Cli, BadInputIsOneLineAndLeavesNoFile) {
  makeRobot();
  put("empty.glb", "");
  put("text.glb", "this is no model");
  put("cut.glb", content("robot.glb").substr(0, 5000));
  put("points.obj", "v 0 0 0\nv 1 0 0\n");
  const std::vector<std::string> before = files();
  for (const char* name : {"empty.glb", "text.glb", "cut.glb", "points.obj", "missing.glb", "."}) {
    expectOneLine(run({"rig", name, "-o", "out.glb", "--json", "report.json"}), 1);
    expectOneLine(run({"preview", name, "-o", "out.png"}), 1);
  }
  expectOneLine(run({"rig", "robot.glb", "-o", "nowhere/out.glb"}), 1);
  EXPECT_EQ(files(), before);
}

// 16 million faces, of 16 bytes each in Assimp's memory, in a file of 40 bytes. In a process of its own: what this one
// has freed would be the importer's as well.
TEST_F(Cli, ASmallFileGetsLessThanAQuarterOfAGigabyte) {
  if (kAddressSanitizer) GTEST_SKIP() << "memory is not limited there";
  put("t.off", "OFF\n3 16000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Result refused = run({"convert", "t.off", "t.glb"});
  expectOneLine(refused, 1);
  EXPECT_THAT(refused.error, HasSubstr("asks for more memory than a file of its size may"));
}

TEST_F(Cli, NamesOutOfFilesDoNotCommandTheTerminal) {
  const std::string name = "\x1b]0;OWNED\x07\x1b[31mred\r\nlimber: forged";
  testing::GltfBuilder model;
  const Index times = model.accessor(std::vector<float>{0, 1}, 5126, "SCALAR", 2);
  model.json["accessors"][times].update({{"min", Json::array({0})}, {"max", Json::array({1})}});
  const Index turns = model.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC4", 2);
  model.push("nodes", {{"name", name}});
  model.push("scenes", {{"nodes", Json::array({0})}});
  const Json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}};
  const Json sampler = {{"input", times}, {"output", turns}};
  model.push("animations",
             {{"name", name}, {"channels", Json::array({channel})}, {"samplers", Json::array({sampler})}});
  const Bytes glb = model.glb();
  put("a.glb", std::string(glb.begin(), glb.end()));
  for (const std::vector<std::string>& call :
       std::vector<std::vector<std::string>>{{"info", "a.glb"},
                                             {"convert", "a.glb", "-o", "b.glb"},
                                             {"convert", "a.glb", "-o", "c.glb", "--clip", name}}) {
    const Result result = run(call);
    for (const std::string& text : {result.out, result.error}) {
      for (const char* control : {"\x1b", "\x07", "\r", "\nlimber: forged"}) EXPECT_THAT(text, Not(HasSubstr(control)));
    }
  }
  EXPECT_THAT(run({"info", "a.glb"}).out, HasSubstr("\\x1b]0;OWNED\\x07"));
  expectOneLine(run({"convert", "a.glb", "-o", "b.glb", "--clip", "none\nlimber: forged"}), 1);
}

TEST_F(Cli, UnknownNamesListTheKnownOnes) {
  makeRobot();
  EXPECT_THAT(run({"rig", "robot.glb", "-o", "o.glb", "--rigger", "magic"}).error, HasSubstr("sphere-mesh"));
  EXPECT_THAT(run({"rig", "robot.glb", "-o", "o.glb", "--skinning", "magic"}).error, HasSubstr("bone-heat"));
  EXPECT_THAT(run({"sample", "unicorn", "-o", "o.glb"}).error, AllOf(HasSubstr("quadruped"), HasSubstr("walk")));
  EXPECT_THAT(run({"preview", "robot.glb", "-o", "o.png", "--show", "magic"}).error, HasSubstr("weights"));
  EXPECT_THAT(run({"preview", "robot.glb", "-o", "o.png", "--view", "magic"}).error, HasSubstr("three-quarter"));
  EXPECT_THAT(run({"preview", "robot.glb", "-o", "o.png", "--deformer", "magic"}).error, HasSubstr("delta-mush"));
}

TEST_F(Cli, AnUnknownCommandIsNamedAndTheKnownOnesListed) {
  const Result bogus = run({"bogus", "--flag"});
  expectOneLine(bogus, 2);
  EXPECT_THAT(bogus.error, AllOf(HasSubstr("'bogus'"), HasSubstr("rig, info")));
  const Result below = run({"evaluate", "bogus"});
  expectOneLine(below, 2);
  EXPECT_THAT(below.error, AllOf(HasSubstr("'bogus'"), HasSubstr("weights, rig"), HasSubstr("skinning")));
}

TEST_F(Cli, RetargetNamesTheArgumentThatIsMissing) {
  EXPECT_THAT(run({"retarget", "-o", "o.glb"}).error, StartsWith("limber: MODEL is required"));
  EXPECT_THAT(run({"retarget", "hero.glb", "-o", "o.glb"}).error, StartsWith("limber: MOTIONS is required"));
  const Result many = run({"retarget", "--characters", "heroes.txt", "-o", "o"});
  expectOneLine(many, 2);
  EXPECT_THAT(many.error, StartsWith("limber: MOTIONS is required"));
}

TEST_F(Cli, WhatStandardOutputDoesNotTakeIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  makeRobot();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"info", "robot.glb"}, {"info", "robot.glb", "--json"}, {"--help"}, {"rig", "robot.glb", "-o", "out.glb"}}) {
    Running running(arguments, folder_, "/dev/full");
    const Result result = running.wait();
    EXPECT_EQ(result.code, 4) << arguments[0];
    EXPECT_THAT(result.error, HasSubstr("limber: ")) << arguments[0];
  }
}

TEST_F(Cli, TakingARigOutSaysWhatWent) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "rigged.glb"}).code, 0);
  const auto joints = nlohmann::json::parse(run({"info", "rigged.glb", "--json"}).out).at("joints");
  const Result result = run({"rig", "rigged.glb", "--replace-rig", "-o", "out.glb", "--json", "report.json"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr(std::string("taken out: ").append(joints.dump()).append(" joints, 0 clips")));
  EXPECT_EQ(nlohmann::json::parse(content("report.json")).at("counts").at("removed_joints"), joints);
}

TEST_F(Cli, ErrorsOfTheGeometryNameTheFile) {
  put("line.gltf", R"({"asset": {"version": "2.0"}, "nodes": [{}], "scenes": [{"nodes": [0]}], "scene": 0})");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"rig", "line.gltf", "-o", "out.glb"}, {"preview", "line.gltf", "-o", "out.png"}}) {
    const Result result = run(arguments);
    expectOneLine(result, 1);
    EXPECT_THAT(result.error, StartsWith("limber: line.gltf: has no triangle"));
  }
}

TEST_F(Cli, TheOutputsNameIsCheckedBeforeAnyWork) {
  for (const char* name : {"out.3ds", "out", "out.png"}) {
    const Result result = run({"rig", "missing.glb", "-o", name});
    expectOneLine(result, 1);
    EXPECT_THAT(result.error, AllOf(HasSubstr(name), HasSubstr(".glb"), Not(HasSubstr("missing"))));
  }
}

TEST_F(Cli, StrictTakesWarningsAsErrors) {
  put("sliver.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\nf 1 1 2\n");
  const Result lenient = run({"rig", "sliver.obj", "--handles", "1", "-o", "out.glb"});
  ASSERT_EQ(lenient.code, 0) << lenient.error;
  ASSERT_THAT(lenient.error, HasSubstr("warning"));
  EXPECT_THAT(lenient.out, Not(HasSubstr("warning")));
  expectOneLine(run({"rig", "sliver.obj", "--handles", "1", "-o", "strict.glb", "--strict"}), 1);
  EXPECT_FALSE(fs::exists(folder_ / "strict.glb"));
}

TEST_F(Cli, DrawsEveryKindOfPicture) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "rigged.glb"}).code, 0);
  for (const char* show : {"model", "handles", "weights", "bones"}) {
    EXPECT_EQ(run({"preview", "rigged.glb", "--show", show, "--size", "80x60", "-o", "picture.png"}).code, 0);
    const std::string png = content("picture.png");
    EXPECT_THAT(png, StartsWith("\x89PNG"));
    EXPECT_EQ(png.substr(16, 8), std::string("\0\0\0\x50\0\0\0\x3c", 8));  // width and height
  }
  expectOneLine(run({"preview", "robot.glb", "--show", "handles", "-o", "none.png"}), 1);
  for (const char* size : {"80", "80x", "0x0", "99999x10", "80x60x3"}) {
    expectOneLine(run({"preview", "robot.glb", "--size", size, "-o", "none.png"}), 1);
  }
  EXPECT_FALSE(fs::exists(folder_ / "none.png"));
}

TEST_F(Cli, WeightsAreComparedWithThemselvesAndWithOthers) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "20", "-q", "-o", "truth.glb"}).code, 0);
  const auto same = nlohmann::json::parse(run({"evaluate", "weights", "truth.glb", "truth.glb", "--json"}).out);
  EXPECT_EQ(same.at("l1"), 0);
  ASSERT_EQ(run({"rig", "truth.glb", "--keep-skeleton", "--max-influences", "1", "-q", "-o", "hard.glb"}).code, 0);
  const auto other = nlohmann::json::parse(run({"evaluate", "weights", "hard.glb", "truth.glb", "--json"}).out);
  EXPECT_GT(other.at("l1").get<double>(), 0.01);
  const Result table = run({"evaluate", "skinning", "."});
  EXPECT_EQ(table.code, 0) << table.error;
  EXPECT_THAT(table.out, HasSubstr("truth"));
  expectOneLine(run({"evaluate", "weights", "robot.glb", "truth.glb"}), 1);
}

TEST_F(Cli, RigsOfASplitAreDrawnIntoOnePicture) {
  makeRobot();
  ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "truth.glb"}).code, 0);
  put("list.tsv", "path\tkind\tsplit\ntruth.glb\trobot\tone\ntruth.glb\trobot\tone\nmissing.glb\trobot\tother\n");
  const Result drawn = run({"evaluate", "templates", "--labels", "list.tsv", "--split", "one", "--sheet", "sheet.png"});
  EXPECT_EQ(drawn.code, 0) << drawn.error;
  EXPECT_THAT(drawn.out, HasSubstr("of 2"));
  const std::string png = content("sheet.png");
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x01\x40\0\0\0\xa0", 8));  // two side by side
  const Result riggers = run({"evaluate", "templates", "--labels", "list.tsv", "--split", "one", "--rigger", "prop",
                              "--rigger", "curve-skeleton"});
  EXPECT_EQ(riggers.code, 0) << riggers.error;
  EXPECT_THAT(riggers.out, AllOf(HasSubstr("| one (2) | prop |"), HasSubstr("| one (2) | curve-skeleton |")));
  expectOneLine(run({"evaluate", "templates", "truth.glb", "--rigger", "magic"}), 1);
  const Result none = run({"evaluate", "templates", "--labels", "list.tsv", "--split", "bogus"});
  expectOneLine(none, 1);
  EXPECT_THAT(none.error, HasSubstr("bogus"));
}

TEST_F(Cli, ATableOfNothingIsAnError) {
  makeRobot();
  put("walk.bvh", "no motion");
  const Result unread = run({"evaluate", "templates", "robot.glb", "missing.glb", "-o", "table.md"});
  expectOneLine(unread, 1);
  EXPECT_THAT(unread.error, HasSubstr("robot.glb"));
  EXPECT_THAT(run({"evaluate", "templates", "robot.glb", "--template", "magic"}).error, HasSubstr("quadruped"));
  expectOneLine(run({"evaluate", "skinning", ".", "-o", "table.md"}), 1);
  expectOneLine(run({"evaluate", "retargeting", "--motion", "walk.bvh", "--character", "robot.glb"}), 1);
  EXPECT_EQ(files(), (std::vector<std::string>{"robot.glb", "walk.bvh"}));
}

TEST_F(Cli, AReportThatCannotBeWrittenLeavesNoModel) {
  makeRobot();
  for (const char* name : {"out.glb", "out.gltf"}) {
    expectOneLine(run({"rig", "robot.glb", "--handles", "9", "-o", name, "--json", "nowhere/report.json"}), 1);
  }
  EXPECT_EQ(files(), std::vector<std::string>{"robot.glb"});
}

TEST_F(Cli, InterruptedWhileWaitingForInput) {
  Running running({"rig", "-", "-o", "out.glb"}, folder_);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // until it reads
  running.signal(SIGINT);
  const Result result = running.waitWithOpenInput();
  expectOneLine(result, 130);
  EXPECT_TRUE(files().empty());
}

// A bumpy ball of binary PLY, large enough to be at work for a while.
std::string largeModel() {
  constexpr int kRings = 600, kAround = 600;
  std::string body;
  const auto put = [&](const auto& value) { body.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
  for (int r = 0; r < kRings; ++r) {
    for (int i = 0; i < kAround; ++i) {
      const double v = 3.14159265 * (r + 0.5) / kRings, u = 2 * 3.14159265 * i / kAround;
      const double radius = 1 + 0.2 * std::sin(9 * u) * std::sin(7 * v);
      for (const double x : {std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u)}) put(float(radius * x));
    }
  }
  int faces = 0;
  for (int r = 0; r + 1 < kRings; ++r) {
    for (int i = 0; i < kAround; ++i) {
      const int a = r * kAround + i, b = r * kAround + (i + 1) % kAround;
      for (const std::array<int, 3>& face : {std::array<int, 3>{a, b, b + kAround}, {a, b + kAround, a + kAround}}) {
        put(static_cast<unsigned char>(3));
        for (const int v : face) put(v);
        ++faces;
      }
    }
  }
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\nelement vertex " << kRings * kAround
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  return header.str() + body;
}

TEST_F(Cli, InterruptedAtWorkItLeavesNoFile) {
  put("large.ply", largeModel());
  Running running({"rig", "large.ply", "-o", "out.glb", "--json", "report.json"}, folder_);
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  running.signal(SIGTERM);
  expectOneLine(running.wait(), 130);
  EXPECT_EQ(files(), std::vector<std::string>{"large.ply"});
}

}  // namespace
}  // namespace limber
