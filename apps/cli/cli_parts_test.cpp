// limber parts, run as a user runs it.
#include <string>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(Cli, PartsAreWrittenAsMaterialsOrAsMeshes) {
  ASSERT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "--quiet"}).code, 0);
  const Result painted = run({"parts", "fox.glb", "--count", "4", "-o", "painted.glb"});
  EXPECT_EQ(painted.code, 0) << painted.error;
  EXPECT_THAT(painted.out, AllOf(HasSubstr("4 parts"), HasSubstr("part_04"), HasSubstr("written: painted.glb")));
  keep("painted.glb");
  const Result split = run({"parts", "fox.glb", "--count", "4", "--split", "-o", "split.glb"});
  EXPECT_EQ(split.code, 0) << split.error;
  keep("split.glb");
  EXPECT_EQ(run({"parts", "fox.glb", "--split", "-o", "split.obj", "--quiet"}).code, 0);
  EXPECT_THAT(content("split.obj"), AllOf(HasSubstr("g part_01_0"), HasSubstr("usemtl cut")));
}

TEST_F(Cli, EachPartIsAWatertightFileToPrint) {
  ASSERT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "--quiet"}).code, 0);
  const Result split = run({"parts", "fox.glb", "--count", "3", "--split", "-o", "print.stl"});
  EXPECT_EQ(split.code, 0) << split.error;
  EXPECT_EQ(split.error, "");
  EXPECT_THAT(files(), ::testing::IsSupersetOf({"print_part_01.stl", "print_part_02.stl", "print_part_03.stl"}));
  for (const char* name : {"print_part_01.stl", "print_part_02.stl", "print_part_03.stl"}) {
    EXPECT_THAT(run({"info", name}).out, HasSubstr("watertight      yes")) << name;
  }
}

TEST_F(Cli, APartsFileNeverTakesThePlaceOfTheModel) {
  ASSERT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "--quiet"}).code, 0);
  ASSERT_EQ(run({"parts", "fox.glb", "--count", "3", "--split", "-o", "print.stl", "--quiet"}).code, 0);
  const std::string before = content("print_part_01.stl");
  const Result again = run({"parts", "print_part_01.stl", "--count", "2", "--split", "-o", "print.stl"});
  EXPECT_NE(again.code, 0);
  EXPECT_THAT(again.error, HasSubstr("would take the place of"));
  EXPECT_EQ(content("print_part_01.stl"), before);
}

TEST_F(Cli, FilesOfPartsHaveNamesThatEveryFileSystemTakes) {
  ASSERT_EQ(run({"sample", "quadruped", "-o", "fox.glb", "--quiet"}).code, 0);
  ASSERT_EQ(run({"rig", "fox.glb", "--handles", "4", "-o", "rigged.gltf", "--quiet"}).code, 0);
  std::string text = content("rigged.gltf");
  for (const auto& [handle, name] : std::vector<std::pair<std::string, std::string>>{
           {"handle_00", "Bone"}, {"handle_02.L", "bone"}, {"handle_02.R", "a<b>|c?*\\\"d"}}) {
    const std::size_t at = text.find("\"" + handle + "\"");
    ASSERT_NE(at, std::string::npos);
    text.replace(at + 1, handle.size(), name);
  }
  put("rigged.gltf", text);
  const Result split = run({"parts", "rigged.gltf", "--detail", "joints", "--split", "-o", "out.ply"});
  EXPECT_EQ(split.code, 0) << split.error;
  EXPECT_THAT(files(), ::testing::IsSupersetOf({"out_Bone.ply", "out_bone_2.ply", "out_a_b__c___d.ply"}));
}

TEST_F(Cli, PartsThatCannotBeAreOneLineAndNoFile) {
  makeRobot();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"parts", "robot.glb", "-o", "out.stl"},
                                             {"parts", "robot.glb", "-o", "out.fbx"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--by", "colour"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--by", "weights"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--detail", "cells"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--open"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--split", "--keep-colours"},
                                             {"parts", "robot.glb", "-o", "out.glb", "--by", "weights", "--count", "3"},
                                             {"preview", "robot.glb", "-o", "out.png", "--count", "3"}}) {
    expectOneLine(run(arguments), 1);
  }
  EXPECT_THAT(files(), ::testing::ElementsAre("robot.glb"));
}

TEST_F(Cli, APictureShowsTheParts) {
  makeRobot();
  EXPECT_EQ(run({"preview", "robot.glb", "--show", "parts", "-o", "parts.png", "--size", "64x64"}).code, 0);
  EXPECT_EQ(run({"preview", "robot.glb", "-o", "model.png", "--size", "64x64"}).code, 0);
  EXPECT_NE(content("parts.png"), content("model.png"));
  // One colour for each part: the picture goes by how many there are, and by nothing else.
  const auto pictureOf = [&](const std::string& count) {
    EXPECT_EQ(run({"preview", "robot.glb", "--show", "parts", "--count", count, "-o", "n.png", "--size", "64x64"}).code,
              0);
    return content("n.png");
  };
  const std::string two = pictureOf("2");
  EXPECT_NE(two, pictureOf("3"));
  EXPECT_NE(two, pictureOf("1"));
  EXPECT_EQ(two, pictureOf("2"));
}

}  // namespace
}  // namespace limber
