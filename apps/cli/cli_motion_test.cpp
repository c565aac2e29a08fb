// Poses, sessions and motions, through the program itself.
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class CliPose : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    makeRobot();
    ASSERT_EQ(run({"rig", "robot.glb", "--handles", "9", "-q", "-o", "rigged.glb"}).code, 0);
    joint_ = info("rigged.glb").at("joint_names").back().get<std::string>();
  }
  nlohmann::json info(const char* name) { return nlohmann::json::parse(run({"info", name, "--json"}).out); }

  std::string joint_;
};

TEST_F(CliPose, APoseKeepsTheRig) {
  const Result result = run({"pose", "rigged.glb", "--turn", joint_ + "=y:30", "-o", "posed.glb"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(info("posed.glb").at("joint_names"), info("rigged.glb").at("joint_names"));
  EXPECT_EQ(info("posed.glb").at("weights"), info("rigged.glb").at("weights"));
  EXPECT_NE(content("posed.glb"), content("rigged.glb"));
  keep("posed.glb");
}

TEST_F(CliPose, BakesToMeshFormats) {
  for (const char* name : {"posed.obj", "posed.stl", "posed.ply"}) {
    const Result result = run({"pose", "rigged.glb", "--turn", joint_ + "=y:30", "--bake", "-o", name});
    EXPECT_EQ(result.code, 0) << result.error;
    EXPECT_EQ(info(name).at("triangles"), info("rigged.glb").at("triangles")) << name;
  }
}

TEST_F(CliPose, ANewRestPoseIsWritten) {
  const Result result = run({"pose", "rigged.glb", "--turn", joint_ + "=y:30", "--set-rest", "-o", "rest.glb"});
  EXPECT_EQ(result.code, 0) << result.error;
  EXPECT_EQ(info("rest.glb").at("joint_names"), info("rigged.glb").at("joint_names"));
  EXPECT_EQ(info("rest.glb").at("weights"), info("rigged.glb").at("weights"));
  keep("rest.glb");
}

TEST_F(CliPose, AnUnknownJointIsOneLineAndLeavesNoFile) {
  const std::vector<std::string> before = files();
  const Result result = run({"pose", "rigged.glb", "--turn", "no such joint=y:30", "-o", "posed.glb"});
  expectOneLine(result, 1);
  EXPECT_THAT(result.error, HasSubstr("no such joint"));
  EXPECT_EQ(files(), before);
}

TEST_F(Cli, SessionReplayDoesWhatTheListSays) {
  fs::create_directory(folder_ / "models");
  run({"sample", "stool", "-o", "models/stool.glb", "-q"});
  put("commands.json", R"({"limber_commands": 1, "commands": [{"do": "open_file", "file": "models/stool.glb"},
    {"do": "set_handles", "count": 8},
    {"do": "place_joint", "joint": "handle_00", "position": [0, 2, 0], "relative": true}]})");
  const Result done = run({"session", "replay", "commands.json", "-o", "posed.glb"});
  EXPECT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(done.out, HasSubstr("3 commands done: "));
  const nlohmann::json info = nlohmann::json::parse(run({"info", "posed.glb", "--json"}).out);
  EXPECT_THAT(info.at("joint_names").size(), ::testing::AnyOf(8, 9));  // two where one has an image
  EXPECT_EQ(run({"session", "replay", "commands.json", "-o", "posed.stl", "-q"}).out, "");
}

TEST_F(Cli, SessionReplayNamesTheCommandThatFails) {
  put("commands.json", R"({"limber_commands": 1, "commands": [{"do": "open_sample", "name": "stool"},
    {"do": "reset_joint", "joint": "tail"}]})");
  const Result failed = run({"session", "replay", "commands.json", "-o", "out.glb"});
  expectOneLine(failed, 1);
  EXPECT_THAT(failed.error, AllOf(HasSubstr("commands.json: commands[1]"), HasSubstr("'tail'")));
  put("commands.json", R"({"limber_commands": 1, "commands": [{"do": "open_file", "file": "../secret.glb"}]})");
  expectOneLine(run({"session", "replay", "commands.json", "-o", "out.glb"}), 1);
  EXPECT_EQ(files(), std::vector<std::string>{"commands.json"});
}

// A ZIP archive of files that are stored, not packed.
std::string archiveOf(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto number = [](std::size_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text.push_back(static_cast<char>(value >> (8 * i) & 255));
    return text;
  };
  const auto crc = [](const std::string& text) {
    std::uint32_t sum = ~0u;
    for (const char c : text) {
      sum ^= static_cast<unsigned char>(c);
      for (int bit = 0; bit < 8; ++bit) sum = sum & 1 ? 0xedb88320u ^ (sum >> 1) : sum >> 1;
    }
    return ~sum;
  };
  std::string body, directory;
  for (const auto& [path, content] : files) {
    const std::string fields = number(20, 2) + std::string(8, '\0') + number(crc(content), 4) +
                               number(content.size(), 4) + number(content.size(), 4) + number(path.size(), 2) +
                               std::string(2, '\0');
    directory += "PK\1\2" + number(20, 2) + fields + std::string(10, '\0') + number(body.size(), 4) + path;
    body += "PK\3\4" + fields + path + content;
  }
  return body + directory + "PK\5\6" + std::string(4, '\0') + number(files.size(), 2) + number(files.size(), 2) +
         number(directory.size(), 4) + number(body.size(), 4) + std::string(2, '\0');
}

TEST_F(Cli, SampleListsAndWritesScenes) {
  const Result list = run({"sample"});
  EXPECT_EQ(list.code, 0);
  EXPECT_THAT(list.out,
              AllOf(HasSubstr("winged"), HasSubstr("walk"), HasSubstr("dancing-stool     the model footstool")));
  EXPECT_EQ(run({"sample", "dancing-stool", "-o", "stool.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"sample", "dancing-stool", "-o", "stool.json", "-q"}).code, 0);
  EXPECT_EQ(run({"session", "replay", "stool.json", "-o", "again.glb", "-q"}).code, 0);
  EXPECT_EQ(content("stool.glb"), content("again.glb"));
  EXPECT_NE(run({"sample", "dancing-stool", "-o", "stool.bvh"}).code, 0);
  EXPECT_THAT(run({"sample", "dancing-stool"}).error, HasSubstr("limber sample dancing-stool -o FILE"));
}

TEST_F(Cli, SessionReplayTakesALimberFile) {
  run({"sample", "stool", "-o", "stool.glb", "-q"});
  const std::string list = R"({"limber_commands": 1, "commands": [{"do": "open_file", "file": "files/0/stool.glb"},
    {"do": "set_handles", "count": 8}]})";
  const std::string whole = archiveOf({{"commands.json", list}, {"files/0/stool.glb", content("stool.glb")}});
  put("work.limber", whole);
  const Result done = run({"session", "replay", "work.limber", "-o", "posed.glb"});
  EXPECT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(done.out, HasSubstr("2 commands done: "));

  const auto refusal = [&](const std::string& bytes) {
    put("bad.limber", bytes);
    const Result refused = run({"session", "replay", "bad.limber", "-o", "out.glb"});
    expectOneLine(refused, 1);
    EXPECT_THAT(refused.error, HasSubstr("bad.limber"));
    EXPECT_FALSE(fs::exists(folder_ / "out.glb"));
    return refused.error;
  };
  EXPECT_THAT(refusal(archiveOf({{"notes.txt", "nothing"}})), HasSubstr("commands.json"));
  EXPECT_THAT(refusal(archiveOf({{"commands.json", list}, {"commands.json", list}})), HasSubstr("twice"));
  EXPECT_THAT(refusal(archiveOf({{"commands.json", list}})), HasSubstr("stool.glb"));
  EXPECT_THAT(refusal(whole.substr(0, whole.size() / 2)), HasSubstr("ZIP"));
  std::string damaged = whole;
  damaged[whole.size() / 2] ^= 1;
  EXPECT_THAT(refusal(damaged), HasSubstr("damaged"));
  // Entries that no command names are not unpacked, wherever their names lead.
  put("more.limber",
      archiveOf({{"commands.json", R"({"limber_commands": 1, "commands": [{"do": "open_sample", "name": "biped"}]})"},
                 {"../out", "x"}}));
  EXPECT_EQ(run({"session", "replay", "more.limber", "-o", "posed.glb"}).code, 0);
  EXPECT_FALSE(fs::exists(folder_.parent_path() / "out"));
}

nlohmann::json infoOf(const Result& result) {
  return nlohmann::json::parse(result.out);
}

const std::string kWalk =
    "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\nJOINT LeftLeg\n{\nOFFSET 20 -50 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd "
    "Site\n{\nOFFSET 0 -40 0\n}\n}\nJOINT RightLeg\n{\nOFFSET -20 -50 0\nCHANNELS 3 Zrotation Xrotation "
    "Yrotation\nEnd Site\n{\nOFFSET 0 -40 0\n}\n}\n}\nMOTION\nFrames: 5\nFrame Time: 0.1\n"
    "0 90 0 0 0 0 0 30 0 0 0 0\n0 91 10 0 0 0 0 20 0 0 5 0\n0 92 20 0 0 0 0 10 0 0 10 0\n"
    "0 91 30 0 0 0 0 0 0 0 20 0\n0 90 40 0 0 0 0 -10 0 0 30 0\n";

TEST_F(Cli, ConvertGoesFromBvhToGltfAndBack) {
  put("walk.bvh", kWalk);
  const Result there = run({"convert", "walk.bvh", "walk.glb", "--unit", "cm"});
  EXPECT_EQ(there.code, 0) << there.error;
  EXPECT_THAT(there.out, AllOf(HasSubstr("written: walk.glb, 1 clip\n"), HasSubstr("5 frames at 10 a second")));
  keep("walk.glb");
  const Result info = run({"info", "walk.glb"});
  EXPECT_THAT(info.out, AllOf(HasSubstr("walk: 0.400 s"), HasSubstr("LeftLeg_end")));
  EXPECT_EQ(run({"convert", "walk.glb", "back.bvh", "--output-unit", "cm", "-q"}).code, 0);
  EXPECT_THAT(content("back.bvh"),
              AllOf(HasSubstr("OFFSET 20 -50 0\n"), HasSubstr("Frames: 5\n"), HasSubstr("\n 0 90 0 ")));
  EXPECT_THAT(run({"info", "back.bvh"}).out, AllOf(HasSubstr("bvh"), HasSubstr("back: 0.400 s")));
}

TEST_F(Cli, ConvertCutsMirrorsAndResamples) {
  put("walk.bvh", kWalk);
  EXPECT_EQ(run({"convert", "walk.bvh", "-o", "a.bvh", "--trim", "0.1:0.3", "--mirror", "--fps", "20", "-q"}).code, 0);
  const std::string cut = content("a.bvh"), head = "Frames: 5\nFrame Time: 0.05\n";
  ASSERT_THAT(cut, HasSubstr(head));
  std::istringstream row(cut.substr(cut.find(head) + head.size()));
  for (const double wanted : {0, 91, 10, 0, 0, 0, 0, 5, 0, 0, 20, 0}) {  // the second frame, its legs exchanged
    double value = 0;
    row >> value;
    EXPECT_NEAR(value, wanted, 1e-4);
  }
  put("run.bvh", kWalk);
  EXPECT_EQ(run({"convert", "walk.bvh", "run.bvh", "both.glb", "-q"}).code, 0);
  EXPECT_THAT(run({"info", "both.glb"}).out, AllOf(HasSubstr("walk: 0.400 s"), HasSubstr("run: 0.400 s")));
  keep("both.glb");
  EXPECT_EQ(run({"convert", "both.glb", "each.bvh", "-q"}).code, 0);
  EXPECT_EQ(content("each_walk.bvh"), content("each_run.bvh"));
  EXPECT_NE(content("each_walk.bvh"), "");
  const Result one = run({"convert", "both.glb", "one.glb", "--clip", "run", "--trim", "0:0.2"});
  EXPECT_EQ(one.code, 0) << one.error;
  EXPECT_THAT(one.out, AllOf(HasSubstr("run"), HasSubstr("3 frames"), Not(HasSubstr("walk"))));
  EXPECT_THAT(run({"info", "one.glb"}).out, AllOf(HasSubstr("run: 0.200 s"), Not(HasSubstr("walk: "))));
}

// A triangle with one blend shape, which two clips move from 0 to 1 in a second.
const std::string kBlendShape = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"name": "face", "mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "targets": [{"POSITION": 1}]}]}],
  "buffers": [{"byteLength": 88, "uri": "data:application/octet-stream;base64,)"
                                "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"
                                "AAAAAAAIA/AAAAAAAAgD8AAAAAAACAPw=="
                                R"("}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 36},
    {"buffer": 0, "byteOffset": 72, "byteLength": 16}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 3, "min": [0, 0, 0], "max": [0, 0, 1]},
    {"bufferView": 2, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [1]},
    {"bufferView": 2, "byteOffset": 8, "componentType": 5126, "type": "SCALAR", "count": 2}],
  "animations": [
    {"name": "smile", "samplers": [{"input": 2, "output": 3}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]},
    {"name": "frown", "samplers": [{"input": 2, "output": 3}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}]})";

TEST_F(Cli, ConvertTakesBlendShapesAlone) {
  put("face.gltf", kBlendShape);
  for (const std::string output : {"face.glb", "face.fbx"}) {
    const Result whole = run({"convert", "face.gltf", output});
    EXPECT_EQ(whole.code, 0) << whole.error;
    EXPECT_THAT(whole.out, HasSubstr("written: " + output + ", 2 clips"));
    EXPECT_THAT(run({"info", output}).out, AllOf(HasSubstr("smile: 1.000 s"), HasSubstr("frown: 1.000 s")));
  }
  EXPECT_EQ(run({"convert", "face.gltf", "half.glb", "--clip", "frown", "--trim", "0:0.5", "-q"}).code, 0);
  EXPECT_THAT(run({"info", "half.glb"}).out, AllOf(HasSubstr("frown: 0.500 s"), Not(HasSubstr("smile"))));
  keep("half.glb");
  EXPECT_EQ(run({"convert", "face.gltf", "face.usda", "--clip", "smile", "-q"}).code, 0);
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& call : {std::vector<std::string>{"face.bvh"},
                                               {"face.vrma"},
                                               {"in_place.glb", "--in-place"},
                                               {"left.glb", "--mirror"}}) {
    std::vector<std::string> words = {"convert", "face.gltf"};
    words.insert(words.end(), call.begin(), call.end());
    expectOneLine(run(words), 1);
  }
  EXPECT_EQ(files(), before);
}

// A bone and its tip; a clip brings the bone's scale, or what `path` names, from 1 to 2 in a second.
std::string growingBone(const std::string& path) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
  "nodes": [{"name": "bone", "children": [1]}, {"name": "tip", "translation": [0, 1, 0]}],
  "buffers": [{"byteLength": 32,
    "uri": "data:application/octet-stream;base64,AAAAAAAAgD8AAIA/AACAPwAAgD8AAABAAAAAQAAAAEA="}],
  "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "type": "SCALAR", "count": 2, "min": [0], "max": [1]},
    {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 2}],
  "animations": [{"name": "grow", "samplers": [{"input": 0, "output": 1}],
    "channels": [{"sampler": 0, "target": {"node": 0, "path": ")" +
         path + R"("}}]}]})";
}

TEST_F(Cli, ConvertTellsOfScalesThatABvhDoesNotHold) {
  put("grow.gltf", growingBone("scale"));
  const Result grown = run({"convert", "grow.gltf", "grow.bvh"});
  EXPECT_EQ(grown.code, 0) << grown.error;
  EXPECT_THAT(grown.error, AllOf(HasSubstr("warning: scales of joints change, which a BVH does not hold"),
                                 HasSubstr("[bvh-scales], at bone\n")));
  EXPECT_THAT(content("grow.bvh"), HasSubstr("ROOT bone"));
  put("rise.gltf", growingBone("translation"));
  for (const std::string input : {"grow.gltf", "rise.gltf"}) {
    const std::string output = input == "grow.gltf" ? "grow.glb" : "rise.bvh";
    const Result kept = run({"convert", input, output});
    EXPECT_EQ(kept.code, 0) << kept.error;
    EXPECT_THAT(kept.error, Not(HasSubstr("bvh-scales"))) << output;
  }
  keep("grow.glb");
}

TEST_F(Cli, ConvertRefusesWithOneLine) {
  put("walk.bvh", kWalk);
  put("bad.bvh", kWalk + "1 2 3\n4 5 6\n");
  put("other.bvh", "HIERARCHY\nROOT a\n{\n}\nMOTION\nFrames: 0\nFrame Time: 1\n");
  const Result bad = run({"convert", "bad.bvh", "bad.glb"});
  expectOneLine(bad, 1);
  EXPECT_THAT(bad.error, HasSubstr("bad.bvh: line 33: has 3 of the 12 numbers"));
  const Result late = run({"convert", "walk.bvh", "out.glb", "--trim", "5:"});
  expectOneLine(late, 1);
  EXPECT_THAT(late.error, HasSubstr("nothing of it lies after 5 s"));
  const std::vector<std::vector<std::string>> calls = {{"walk.bvh"},
                                                       {"walk.bvh", "out.obj"},
                                                       {"walk.bvh", "out.glb", "--unit", "parsec"},
                                                       {"walk.bvh", "out.glb", "--trim", "3:1"},
                                                       {"walk.bvh", "out.glb", "--trim", "now"},
                                                       {"walk.bvh", "out.glb", "--clip", "swim", "-q"},
                                                       {"missing.bvh", "out.glb"},
                                                       {"other.bvh", "out.bvh", "-q"}};
  for (std::vector<std::string> call : calls) {
    call.insert(call.begin(), "convert");
    expectOneLine(run(call), 1);
  }
  EXPECT_EQ(run({"convert", "walk.bvh", "other.bvh", "-o", "out.glb", "-q"}).code, 1);
  EXPECT_EQ(files(), (std::vector<std::string>{"bad.bvh", "other.bvh", "walk.bvh"}));
}

TEST_F(Cli, ConvertWritesUsd) {
  ASSERT_EQ(run({"sample", "flying", "-o", "flying.glb", "-q"}).code, 0);
  const Result whole = run({"convert", "flying.glb", "flying.usdz", "--clip", "fly"});
  EXPECT_EQ(whole.code, 0) << whole.error;
  EXPECT_THAT(whole.out, HasSubstr("written: flying.usdz"));
  EXPECT_EQ(content("flying.usdz").substr(0, 2), "PK");
  EXPECT_EQ(run({"convert", "flying.glb", "flying.usdc", "-q"}).code, 0);
  EXPECT_THAT(content("flying.usdc"), StartsWith("PXR-USDC"));
  EXPECT_EQ(run({"convert", "flying.glb", "flying.usda", "-q"}).code, 0);
  EXPECT_THAT(content("flying.usda"), AllOf(StartsWith("#usda 1.0"), HasSubstr("rotations.timeSamples")));
  // A model without a rig.
  makeRobot();
  EXPECT_EQ(run({"convert", "robot.glb", "robot.usda", "-q"}).code, 0);
  EXPECT_THAT(content("robot.usda"), Not(HasSubstr("Skel")));
  const std::vector<std::string> before = files();
  expectOneLine(run({"convert", "flying.glb", "other.usdz", "--clip", "swim", "-q"}), 1);
  EXPECT_EQ(files(), before);
}

TEST_F(Cli, ConvertWritesMeshesAlone) {
  makeRobot();
  for (const char* file : {"robot.obj", "robot.stl", "robot.ply"}) {
    const Result whole = run({"convert", "robot.glb", file});
    EXPECT_EQ(whole.code, 0) << whole.error;
    EXPECT_EQ(whole.error, "");
    EXPECT_THAT(whole.out, AllOf(StartsWith(std::string("written: ") + file), HasSubstr("triangles")));
    EXPECT_EQ(infoOf(run({"info", file, "--json"})).at("triangles"),
              infoOf(run({"info", "robot.glb", "--json"})).at("triangles"))
        << file;
    EXPECT_EQ(infoOf(run({"info", file, "--json"})).at("bounds"),
              infoOf(run({"info", "robot.glb", "--json"})).at("bounds"))
        << file;
  }
  // Of a rigged model the rest pose, which is the mesh that got the rig.
  ASSERT_EQ(run({"sample", "biped", "-o", "person.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);
  ASSERT_EQ(run({"animate", "person.glb", "walk.bvh", "-o", "walking.glb", "-q"}).code, 0);
  const Result rest = run({"convert", "walking.glb", "rest.ply"});
  EXPECT_EQ(rest.code, 0) << rest.error;
  EXPECT_THAT(rest.error, AllOf(HasSubstr("[lost-rig]"), HasSubstr("[lost-clips], at walk\n")));
  ASSERT_EQ(run({"convert", "person.glb", "person.ply", "-q"}).code, 0);
  const auto rested = infoOf(run({"info", "rest.ply", "--json"})).at("bounds"),
             bare = infoOf(run({"info", "person.ply", "--json"})).at("bounds");
  for (const char* corner : {"min", "max"}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(rested.at(corner).at(axis).get<double>(), bare.at(corner).at(axis).get<double>(), 1e-6) << corner;
    }
  }
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& call : {std::vector<std::string>{"walking.glb", "none.obj", "--mirror"},
                                               {"walking.glb", "none.obj", "--clip", "walk"},
                                               {"walking.glb", "none.stl", "--target", "unreal"},
                                               {"walking.glb", "person.glb", "-o", "none.ply"},
                                               {"walk.bvh", "none.ply"}}) {
    std::vector<std::string> words = {"convert"};
    words.insert(words.end(), call.begin(), call.end());
    expectOneLine(run(words), 1);
  }
  EXPECT_EQ(files(), before);
}

TEST_F(Cli, ConvertWarnsOfABodyInAnotherUnit) {
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);  // in metres
  const Result tiny = run({"convert", "walk.bvh", "tiny.glb", "--unit", "cm"});
  EXPECT_EQ(tiny.code, 0);
  EXPECT_THAT(tiny.error, AllOf(StartsWith("warning: the body measures 0.01"), HasSubstr("[unlikely-size]\n")));
  EXPECT_EQ(run({"convert", "walk.bvh", "walk.glb"}).error, "");
  ASSERT_EQ(run({"convert", "walk.bvh", "walk_cm.bvh", "--output-unit", "cm"}).error, "");
  EXPECT_THAT(run({"convert", "walk_cm.bvh", "huge.glb"}).error, HasSubstr("[unlikely-size]"));
  EXPECT_EQ(run({"convert", "walk_cm.bvh", "again.glb", "--unit", "cm"}).error, "");
}

TEST_F(Cli, InfoMeasuresSkeletons) {
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);
  const nlohmann::json walk = infoOf(run({"info", "walk.bvh", "--json"}));
  const double height = walk.at("skeleton_size").at("height"), hips = walk.at("skeleton_size").at("hips");
  EXPECT_GT(height, 1.4);
  EXPECT_LT(height, 1.9);
  EXPECT_NEAR(hips / height, 0.56, 0.1);
  ASSERT_EQ(walk.at("joint_positions").size(), walk.at("joint_names").size());
  const Result text = run({"info", "walk.bvh"});
  EXPECT_THAT(text.out, ContainsRegex("\nskeleton  *1\\.[0-9]* m high from the lowest joint to the highest, hips at "));
  EXPECT_THAT(text.out, Not(HasSubstr("positions in rest pose")));
  EXPECT_EQ(text.error, "");
  const Result listed = run({"info", "walk.bvh", "--joints"});
  EXPECT_THAT(listed.out, HasSubstr("positions in rest pose, in metres: x, y, z\n"));
  const std::string first = walk.at("joint_names")[0];
  EXPECT_THAT(listed.out,
              HasSubstr(fmt::format(
                  "{:16}{:<24} {:10.5f} {:10.5f} {:10.5f}\n", "", first, walk.at("joint_positions")[0][0].get<double>(),
                  walk.at("joint_positions")[0][1].get<double>(), walk.at("joint_positions")[0][2].get<double>())));
  ASSERT_EQ(run({"convert", "walk.bvh", "tiny.glb", "--unit", "cm", "-q"}).code, 0);
  EXPECT_THAT(run({"info", "tiny.glb"}).error, HasSubstr("[unlikely-size]"));
}

TEST_F(Cli, ConvertWritesMotionsForAvatars) {
  ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);
  const Result whole = run({"convert", "walk.bvh", "walk.vrma"});
  EXPECT_EQ(whole.code, 0) << whole.error;
  EXPECT_THAT(whole.out, HasSubstr("written: walk.vrma"));
  EXPECT_THAT(content("walk.vrma"), AllOf(StartsWith("glTF"), HasSubstr("VRMC_vrm_animation"), HasSubstr("leftHand")));
  // And back: a skeleton called by VRM's names.
  EXPECT_EQ(run({"convert", "walk.vrma", "back.bvh", "-q"}).code, 0);
  EXPECT_THAT(content("back.bvh"), HasSubstr("JOINT leftUpperArm"));
  // A skeleton alone is no avatar.
  const std::vector<std::string> before = files();
  expectOneLine(run({"convert", "walk.bvh", "walk.vrm", "-q"}), 1);
  expectOneLine(run({"convert", "walk.vrma", "other.vrma", "--clip", "swim", "-q"}), 1);
  EXPECT_EQ(files(), before);
}

TEST_F(Cli, PreviewShowsClips) {
  put("walk.bvh", kWalk);
  EXPECT_EQ(run({"preview", "walk.bvh", "--frames", "3", "--size", "40x30", "-o", "sheet.png"}).code, 0);
  EXPECT_EQ(run({"preview", "walk.bvh", "--clip", "walk", "--time", "0.2", "--size", "40x30", "-o", "one.png"}).code,
            0);
  EXPECT_EQ(run({"preview", "walk.bvh", "--animate", "--fps", "10", "--size", "40x30", "-o", "moving.png"}).code, 0);
  EXPECT_THAT(content("sheet.png"), StartsWith("\x89PNG"));
  EXPECT_THAT(content("moving.png"), AllOf(StartsWith("\x89PNG"), HasSubstr("acTL"), HasSubstr("fdAT")));
  EXPECT_NE(content("one.png"), "");
  expectOneLine(run({"preview", "walk.bvh", "--clip", "swim", "-o", "none.png"}), 1);
  const Result large = run({"preview", "walk.bvh", "--frames", "400", "--size", "4000x4000", "-o", "none.png"});
  expectOneLine(large, 1);
  EXPECT_THAT(large.error, HasSubstr("--size"));
  expectOneLine(run({"preview", "walk.bvh", "--time", "1", "--frames", "2", "-o", "none.png"}), 2);
  EXPECT_EQ(run({"preview", "walk.bvh", "--turntable", "--fps", "2", "--size", "40x30", "--background", "transparent",
                 "-o", "turn.png"})
                .code,
            0);
  EXPECT_THAT(content("turn.png"), AllOf(StartsWith("\x89PNG"), HasSubstr("acTL")));
  expectOneLine(run({"preview", "walk.bvh", "--turntable", "--animate", "-o", "none.png"}), 2);
  expectOneLine(run({"preview", "walk.bvh", "--fps", "10", "-o", "none.png"}), 1);
  expectOneLine(run({"preview", "walk.bvh", "--background", "pink", "-o", "none.png"}), 1);
}

TEST_F(Cli, PreviewBeginsWithTheFirstClip) {
  put("walk.bvh", kWalk);
  ASSERT_EQ(run({"sample", "flying", "-o", "flying.glb", "-q"}).code, 0);
  const auto picture = [&](const std::string& file, const std::vector<std::string>& options) {
    std::vector<std::string> words = {"preview", file, "--size", "160x120", "-o", "picture.png"};
    words.insert(words.end(), options.begin(), options.end());
    const Result drawn = run(words);
    EXPECT_EQ(drawn.code, 0) << drawn.error;
    return content("picture.png");
  };
  for (const char* file : {"walk.bvh", "flying.glb"}) {
    EXPECT_EQ(picture(file, {}), picture(file, {"--time", "0"})) << file;
    EXPECT_NE(picture(file, {}), picture(file, {"--rest"})) << file;
    EXPECT_EQ(picture(file, {"--show", "bones"}), picture(file, {"--show", "bones", "--time", "0"})) << file;
    expectOneLine(run({"preview", file, "--rest", "--time", "0", "-o", "none.png"}), 2);
  }
  // A pose that was saved is shown, whatever clips there are.
  const auto joints = nlohmann::json::parse(run({"info", "flying.glb", "--json"}).out).at("joint_names");
  ASSERT_EQ(run({"pose", "flying.glb", "--turn", joints[1].get<std::string>() + "=y:40", "-o", "posed.glb", "-q"}).code,
            0);
  EXPECT_EQ(picture("posed.glb", {}), picture("posed.glb", {"--rest"}));
  EXPECT_NE(picture("posed.glb", {}), picture("posed.glb", {"--time", "0"}));
}

TEST_F(Cli, PreviewSaysWhatReadingLost) {
  put("sheet.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Result shown = run({"preview", "sheet.obj", "--size", "40x30", "-o", "sheet.png"});
  EXPECT_EQ(shown.code, 0);
  EXPECT_THAT(shown.error, HasSubstr("[missing-materials]"));
}

// A person out of the practice skeleton's proportions, as a BVH: arms to the sides, walking on the spot.
std::string personBvh(const std::string& prefix) {
  struct Part {
    const char *name, *offset;
    int closes;  // how many joints end after it
  };
  const std::vector<Part> parts = {
      {"Hips", "0 0 0", 0},           {"Spine", "0 12 0", 0},      {"Chest", "0 18 0", 0},
      {"Neck", "0 22 0", 0},          {"Head", "0 10 0", 2},       {"LeftArm", "16 18 0", 0},
      {"LeftForeArm", "28 0 0", 0},   {"LeftHand", "26 0 0", 3},   {"RightArm", "-16 18 0", 0},
      {"RightForeArm", "-28 0 0", 0}, {"RightHand", "-26 0 0", 5}, {"LeftUpLeg", "9 -4 0", 0},
      {"LeftLeg", "0 -42 0", 0},      {"LeftFoot", "0 -42 0", 3},  {"RightUpLeg", "-9 -4 0", 0},
      {"RightLeg", "0 -42 0", 0},     {"RightFoot", "0 -42 0", 4}};
  std::string text = "HIERARCHY\n";
  for (const Part& part : parts) {
    const bool root = &part == parts.data();
    text += (root ? "ROOT " : "JOINT ") + prefix + part.name + "\n{\nOFFSET " + part.offset + "\nCHANNELS " +
            (root ? "6 Xposition Yposition Zposition " : "3 ") + "Zrotation Xrotation Yrotation\n";
    if (part.closes > 0) text += "End Site\n{\nOFFSET 0 0 8\n}\n";
    for (int i = 0; i < part.closes; ++i) text += "}\n";
  }
  text += "MOTION\nFrames: 6\nFrame Time: 0.1\n";
  for (int f = 0; f < 6; ++f) {
    text.append("0 90 ").append(std::to_string(2 * f)).append(" 0 0 0");
    for (std::size_t j = 1; j < parts.size(); ++j) {
      const bool arm = j == 5 || j == 8;
      text.append(" ").append(std::to_string(arm ? 10 * f : 0)).append(" 0 0");
    }
    text += "\n";
  }
  return text;
}

TEST_F(Cli, RetargetPutsEachMotionIntoTheCharacter) {
  put("wave.bvh", personBvh("mixamorig:"));
  put("bow.bvh", personBvh("Bip01 "));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"}).code, 0);
  const Result done = run({"retarget", "hero.glb", "wave.bvh", "bow.bvh", "-o", "moving.glb", "--method", "aligned",
                           "--save-map", "map.json"});
  EXPECT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(done.out,
              AllOf(HasSubstr("wave"), HasSubstr("6 frames at 10 a second"), HasSubstr("written: moving.glb")));
  EXPECT_THAT(run({"info", "moving.glb"}).out, AllOf(HasSubstr("wave: 0.500 s"), HasSubstr("bow: 0.500 s")));
  keep("moving.glb");
  const Result measured =
      run({"evaluate", "motion", "moving.glb", "--source", "wave.bvh", "--truth", "moving.glb", "--json"});
  ASSERT_EQ(measured.code, 0) << measured.error;
  const nlohmann::json measures = nlohmann::json::parse(measured.out);
  EXPECT_LT(measures.at("bone_direction_degrees").get<double>(), 0.5);
  EXPECT_LT(measures.at("joint_error").get<double>(), 1e-12);
  EXPECT_LT(measures.at("self_penetration_share").get<double>(), 0.1);
  EXPECT_GE(measures.at("worst_self_penetration_share"), measures.at("self_penetration_share"));
  const Result ofSkeletons = run({"evaluate", "motion", "wave.bvh", "--source", "wave.bvh"});
  EXPECT_EQ(ofSkeletons.code, 0) << ofSkeletons.error;
  EXPECT_THAT(ofSkeletons.out, AllOf(HasSubstr("contact agreement"), Not(HasSubstr("self-penetration"))));
  const Result again = run({"retarget", "hero.glb", "wave.bvh", "-o", "again.glb", "--map", "map.json", "-q"});
  EXPECT_EQ(again.code, 0) << again.error;
  const Result first =
      run({"retarget", "hero.glb", "wave.bvh", "-o", "first.glb", "--map", "none.json", "--save-map", "none.json"});
  expectOneLine(first, 1);
  EXPECT_THAT(first.error, HasSubstr("leave --map out the first time"));
}

// The clip that was there before, by another method, has the source's name.
TEST_F(Cli, TheClipThatWasAddedLastIsMeasured) {
  put("wave.bvh", personBvh("mixamorig:"));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"animate", "biped.glb", "wave.bvh", "-o", "wave.glb", "--method", "copy", "-q"}).code, 0);
  const Result twice = run({"retarget", "wave.glb", "wave.bvh", "-o", "twice.glb", "--method", "aligned"});
  EXPECT_THAT(twice.out, HasSubstr("wave"));
  const auto degrees = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"evaluate", "motion", "twice.glb", "--source", "wave.bvh", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result measured = run(arguments);
    EXPECT_EQ(measured.code, 0) << measured.error;
    return nlohmann::json::parse(measured.out).at("bone_direction_degrees").get<double>();
  };
  EXPECT_LT(degrees({}), 0.5);
  EXPECT_EQ(degrees({}), degrees({"--clip", "wave_2"}));
  EXPECT_GT(degrees({"--clip", "wave"}), 5);
}

// Clips of names that the character has already get a number behind them.
TEST_F(Cli, RetargetTellsTheNamesOfClipsAndEvaluateFindsTheirSources) {
  put("wave.bvh", personBvh(""));
  put("bow.bvh", personBvh(""));
  run({"sample", "biped", "-o", "biped.glb", "-q"});
  run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"});
  ASSERT_EQ(run({"retarget", "hero.glb", "wave.bvh", "bow.bvh", "-o", "two.glb", "-q"}).code, 0);
  const Result done = run({"retarget", "two.glb", "two.glb", "-o", "four.glb"});
  EXPECT_THAT(done.out, AllOf(HasSubstr("wave_2 "), HasSubstr("bow_2 "))) << done.error;
  EXPECT_EQ(run({"evaluate", "motion", "four.glb", "--source", "two.glb", "--clip", "bow_2"}).code, 0);
  EXPECT_EQ(
      run({"evaluate", "motion", "four.glb", "--source", "two.glb", "--clip", "bow_2", "--source-clip", "wave"}).code,
      0);
  const Result wrong =
      run({"evaluate", "motion", "four.glb", "--source", "two.glb", "--clip", "bow_2", "--source-clip", "bow_2"});
  expectOneLine(wrong, 1);
  EXPECT_THAT(wrong.error, HasSubstr("choose by --source-clip NAME; there are: wave, bow"));
}

TEST_F(Cli, RetargetMovesASkeletonAlone) {
  put("wave.bvh", personBvh(""));
  put("other.bvh", personBvh("Bip01 "));
  const Result done = run({"retarget", "other.bvh", "wave.bvh", "-o", "moving.glb", "--method", "aligned"});
  EXPECT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(run({"info", "moving.glb"}).out, AllOf(HasSubstr("other: 0.500 s"), HasSubstr("wave: 0.500 s")));
  keep("moving.glb");
  const Result measured = run({"evaluate", "motion", "moving.glb", "--source", "wave.bvh", "--json"});
  ASSERT_EQ(measured.code, 0) << measured.error;
  EXPECT_LT(nlohmann::json::parse(measured.out).at("bone_direction_degrees").get<double>(), 0.5);
}

TEST_F(Cli, AnimateRigsWhatHasNoRig) {
  put("wave.bvh", personBvh(""));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  const Result refused = run({"retarget", "biped.glb", "wave.bvh", "-o", "out.glb", "-q"});
  expectOneLine(refused, 1);
  EXPECT_THAT(refused.error, AllOf(HasSubstr("biped.glb"), HasSubstr("limber animate")));
  EXPECT_EQ(run({"animate", "biped.glb", "wave.bvh", "-o", "waving.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"pose", "waving.glb", "--bake", "-o", "still.obj", "-q"}).code, 0);
  put("loose.obj", content("still.obj") + "v 0 0 0\n");
  EXPECT_THAT(run({"animate", "loose.obj", "wave.bvh", "-o", "loose.glb"}).error,
              HasSubstr("warning: vertices that no face uses are left out [loose-vertices]"))
      << "counted once";
  EXPECT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"sample", "stool", "-o", "stool.glb", "-q"}).code, 0);
  const Result thing = run({"animate", "stool.glb", "wave.bvh", "-o", "thing.glb", "-q"});
  expectOneLine(thing, 1);
  EXPECT_THAT(thing.error, AllOf(HasSubstr("like no template"), HasSubstr("--template")));
  EXPECT_FALSE(std::filesystem::exists("thing.glb"));
  EXPECT_EQ(run({"animate", "stool.glb", "wave.bvh", "--template", "humanoid", "-o", "thing.glb", "-q"}).code, 0);
  const Result handles = run({"rig", "stool.glb", "--template", "auto", "-o", "handles.glb"});
  EXPECT_THAT(handles.error, HasSubstr("it gets handles [no-template]"));
  const Result unlike = run({"animate", "fox.glb", "wave.bvh", "-o", "no.glb", "-q"});
  expectOneLine(unlike, 1);
  EXPECT_THAT(unlike.error, HasSubstr("the model was rigged as quadruped"));
  const std::string info = run({"info", "waving.glb"}).out;
  EXPECT_THAT(info, AllOf(HasSubstr("wave: 0.500 s"), HasSubstr("leftUpperArm")));
  keep("waving.glb");
}

TEST_F(Cli, PeopleOfFilesWithZUpStandUp) {
  put("wave.bvh", personBvh(""));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "rigged.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"pose", "rigged.glb", "--turn", "hips=x:90", "--bake", "-o", "lying.obj", "-q"}).code, 0);
  const Result rigged = run({"rig", "lying.obj", "--template", "humanoid", "-o", "lying.glb"});
  EXPECT_THAT(rigged.error, HasSubstr("warning: the model stands along +Z and lies where +Y is up [not-upright]"));
  EXPECT_THAT(run({"rig", "lying.obj", "--template", "quadruped", "--up", "+z", "-o", "told.glb"}).error,
              HasSubstr("[not-upright]"))
      << "of whatever is told to stand so";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"rig", "lying.obj", "--template", "humanoid", "--upright"},
        {"animate", "lying.obj", "wave.bvh"},
        {"retarget", "lying.glb", "wave.bvh"}}) {
    const std::string out = "standing_by_" + command[0] + ".glb";
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"-o", out});
    EXPECT_THAT(run(arguments).error, HasSubstr("is turned to stand along +Y [turned-upright]")) << command[0];
    EXPECT_THAT(run({"retarget", out, "wave.bvh", "-o", "again.glb"}).error, Not(HasSubstr("upright")));
    keep(out);
  }
}

TEST_F(Cli, PosesStartFromAMomentOfAClip) {
  put("wave.bvh", personBvh(""));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"animate", "biped.glb", "wave.bvh", "-o", "waving.glb", "-q"}).code, 0);
  for (const char* moment : {"0", "0.5"}) {
    const std::string out = std::string("still") + moment + ".obj";
    const Result done = run({"pose", "waving.glb", "--clip", "wave", "--time", moment, "--bake", "-o", out, "-q"});
    EXPECT_EQ(done.code, 0) << done.error;
  }
  EXPECT_NE(content("still0.obj"), content("still0.5.obj"));
  const Result refused = run({"pose", "waving.glb", "--clip", "bow", "-o", "none.glb"});
  expectOneLine(refused, 1);
  EXPECT_THAT(refused.error, AllOf(HasSubstr("bow"), HasSubstr("wave")));
}

// The triangle of kBlendShape in a skin of one joint, its shape half on.
std::string skinnedBlendShape() {
  nlohmann::json model = nlohmann::json::parse(kBlendShape);
  model["scenes"][0]["nodes"] = {0, 1};
  model["nodes"][0]["skin"] = 0;
  model["nodes"][0]["weights"] = {0.5};
  model["nodes"].push_back({{"name", "neck"}});
  model["skins"] = nlohmann::json::array({{{"joints", {1}}}});
  const std::string bytes = "AAAAAAAAAAAAAAAA/wAAAP8AAAD/AAAA";  // three times joint 0, three times all of the weight
  model["buffers"].push_back({{"byteLength", 24}, {"uri", "data:application/octet-stream;base64," + bytes}});
  for (const int offset : {0, 12}) {
    const std::size_t view = model["bufferViews"].size();
    model["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", offset}, {"byteLength", 12}});
    nlohmann::json accessor = {{"bufferView", view}, {"componentType", 5121}, {"type", "VEC4"}, {"count", 3}};
    if (offset != 0) accessor["normalized"] = true;
    model["meshes"][0]["primitives"][0]["attributes"][offset == 0 ? "JOINTS_0" : "WEIGHTS_0"] =
        model["accessors"].size();
    model["accessors"].push_back(accessor);
  }
  return model.dump();
}

// The greatest of an OBJ's vertices.
double greatestZ(const std::string& obj) {
  std::istringstream lines(obj);
  double greatest = -1e9, x = 0, y = 0, z = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("v ") && std::istringstream(line.substr(2)) >> x >> y >> z) greatest = std::max(greatest, z);
  }
  return greatest;
}

TEST_F(Cli, PosesHaveTheBlendShapesOfTheirMoment) {
  put("face.gltf", skinnedBlendShape());
  const auto baked = [&](const std::vector<std::string>& moment) {
    std::vector<std::string> words = {"pose", "face.gltf", "--bake", "-o", "still.obj", "-q"};
    words.insert(words.end(), moment.begin(), moment.end());
    const Result done = run(words);
    EXPECT_EQ(done.code, 0) << done.error;
    return greatestZ(content("still.obj"));
  };
  EXPECT_NEAR(baked({}), 0.5, 1e-6) << "as the node has it";
  EXPECT_NEAR(baked({"--clip", "smile", "--time", "0"}), 0, 1e-6);
  EXPECT_NEAR(baked({"--clip", "smile", "--time", "0.25"}), 0.25, 1e-6);
  EXPECT_NEAR(baked({"--clip", "smile", "--time", "1"}), 1, 1e-6);
}

TEST_F(Cli, SampleMotionsMoveTheSamplePerson) {
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"}).code, 0);
  for (const std::string file : {"walk.bvh", "jumping-jack.glb"}) {
    EXPECT_EQ(run({"sample", file.substr(0, file.find('.')), "-o", file, "-q"}).code, 0);
    EXPECT_EQ(run({"retarget", "hero.glb", file, "-o", "moving.glb", "-q"}).code, 0);
    const Result measured = run({"evaluate", "motion", "moving.glb", "--source", file, "--json"});
    ASSERT_EQ(measured.code, 0) << measured.error;
    const nlohmann::json measures = nlohmann::json::parse(measured.out);
    EXPECT_LT(measures.at("sliding_heights_per_second").get<double>(), 0.02);
    EXPECT_GT(measures.at("planted_share").get<double>(), 0.4);
    EXPECT_LT(measures.at("penetration_millimetres").get<double>(), 5);
    EXPECT_LT(measures.at("jerk_ratio").get<double>(), 1.1);
  }
  expectOneLine(run({"sample", "biped", "-o", "biped.bvh", "-q"}), 1);
}

TEST_F(Cli, TheSampleFoxWalks) {
  EXPECT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "fox.glb", "--template", "quadruped", "-o", "rigged.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"sample", "quadruped-walk", "-o", "walk.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"retarget", "rigged.glb", "walk.glb", "-o", "walking.glb", "-q"}).code, 0);
  const Result measured = run({"evaluate", "motion", "walking.glb", "--source", "walk.glb", "--json"});
  ASSERT_EQ(measured.code, 0) << measured.error;
  const nlohmann::json measures = nlohmann::json::parse(measured.out);
  EXPECT_GT(measures.at("planted_share").get<double>(), 0.5);
  EXPECT_LT(measures.at("sliding_heights_per_second").get<double>(), 0.02);
  EXPECT_LT(measures.at("penetration_millimetres").get<double>(), 5);
  EXPECT_LT(measures.at("jerk_ratio").get<double>(), 1.1);
}

// Two of them in one file, the second two metres to the left, its joints' names with "Other" before.
std::string twoPeopleBvh() {
  const std::string one = personBvh(""), other = personBvh("Other");
  const std::size_t motion = one.find("MOTION\n"), rows = one.find("Frame Time: 0.1\n") + 16;
  const std::size_t hierarchy = other.find("ROOT"), otherMotion = other.find("MOTION\n");
  std::string text = one.substr(0, motion) + other.substr(hierarchy, otherMotion - hierarchy);
  text += one.substr(motion, rows - motion);
  std::istringstream left(one.substr(rows)), right(other.substr(other.find("Frame Time: 0.1\n") + 16));
  for (std::string a, b; std::getline(left, a) && std::getline(right, b);)
    text.append(a).append(" 200" + b.substr(1)) += "\n";
  return text;
}

TEST_F(Cli, OfAMotionOfTwoBodiesOneIsChosen) {
  put("wave.bvh", personBvh(""));
  put("two.bvh", twoPeopleBvh());
  EXPECT_EQ(run({"convert", "two.bvh", "two.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"}).code, 0);
  ASSERT_EQ(run({"retarget", "hero.glb", "wave.bvh", "-o", "one.glb", "-q"}).code, 0);
  for (const std::string motion : {"two.bvh", "two.glb"}) {
    const Result refused = run({"retarget", "hero.glb", motion, "-o", "none.glb"});
    expectOneLine(refused, 1);
    EXPECT_THAT(refused.error, AllOf(HasSubstr("holds 2 bodies"), HasSubstr("'Hips' and 'OtherHips'"),
                                     HasSubstr("--skeleton 'Hips'")));
    const Result unknown = run({"retarget", "hero.glb", motion, "-o", "none.glb", "--skeleton", "Pelvis"});
    expectOneLine(unknown, 1);
    EXPECT_THAT(unknown.error, AllOf(HasSubstr("no joint 'Pelvis'"), HasSubstr("'Hips' and 'OtherHips'")));
    for (const std::string body : {"OtherHips", "2"}) {
      const Result done = run({"animate", "hero.glb", motion, "-o", "two_" + body + ".glb", "--skeleton", body});
      ASSERT_EQ(done.code, 0) << done.error;
    }
    EXPECT_EQ(content("two_2.glb"), content("two_OtherHips.glb"));
    // The second is two metres away, and moves as the first does.
    const Result measured = run({"evaluate", "motion", "two_2.glb", "--source", "wave.bvh", "--json"});
    ASSERT_EQ(measured.code, 0) << measured.error;
    EXPECT_LT(nlohmann::json::parse(measured.out).at("bone_direction_degrees").get<double>(), 5);
  }
}

TEST_F(Cli, WhatIsReadIsNamedWhereAFormatIsNot) {
  put("hero.bvh", personBvh(""));
  for (const char* motion : {"moves.npy", "moves.pkl"}) {
    put(motion, "\x80 no motion");
    const Result refused = run({"retarget", "hero.bvh", motion, "-o", "none.glb"});
    expectOneLine(refused, 1);
    EXPECT_THAT(refused.error, AllOf(HasSubstr(motion), HasSubstr(".npz"), HasSubstr("SMPL"), HasSubstr("VRM"),
                                     HasSubstr("VRMA"), HasSubstr("BVH")));
  }
}

TEST_F(Cli, RetargetRefusesWithOneLineAndLeavesNoFile) {
  put("hero.bvh", personBvh(""));
  put("cut.bvh", personBvh("").substr(0, 400));
  EXPECT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  EXPECT_EQ(run({"rig", "biped.glb", "--template", "humanoid", "-o", "hero.glb", "-q"}).code, 0);
  put("map.json", "{\"matches\": 3}");
  const std::vector<std::string> before = files();
  for (const std::vector<std::string>& call :
       std::vector<std::vector<std::string>>{{"hero.glb", "cut.bvh"},
                                             {"hero.glb", "no.bvh"},
                                             {"hero.glb", "hero.bvh", "--method", "magic"},
                                             {"hero.glb", "hero.bvh", "--map", "map.json"},
                                             {"hero.glb", "hero.bvh", "--solver", "magic"}}) {
    std::vector<std::string> arguments = {"retarget"};
    arguments.insert(arguments.end(), call.begin(), call.end());
    arguments.insert(arguments.end(), {"-o", "out.glb", "-q"});
    expectOneLine(run(arguments), 1);
  }
  EXPECT_EQ(files(), before);
}

TEST_F(Cli, ASolverWithoutEffectIsRefused) {
  for (const std::string method : {"spacetime", "aligned", "copy"}) {
    const Result result =
        run({"retarget", "hero.glb", "walk.bvh", "--method", method, "--solver", "fabrik", "-o", "out.glb"});
    expectOneLine(result, 2);
    EXPECT_THAT(result.error, HasSubstr("--solver: has no effect with --method " + method + "; it is for limb-ik"));
  }
}

}  // namespace
}  // namespace limber
