#include "limber/actions/rig/template_file.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/known_error.h"

namespace limber {

namespace {

std::string whatOf(std::string_view json) {
  try {
    parseTemplate(json);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(TemplateFile, ReadsJointsInAnyOrder) {
  const Skeleton skeleton = parseTemplate(R"({"joints": [
    {"name": "hand", "parent": "arm", "position": [2, 1, 0]},
    {"name": "arm", "parent": "root", "position": [1, 1, 0]},
    {"name": "root", "position": [0, 1, 0.5]}]})");
  checkSkeleton(skeleton);
  ASSERT_EQ(skeleton.jointCount(), 3u);
  const std::vector<Affine> globals = restGlobals(skeleton);
  EXPECT_EQ(Vec3(globals[skeleton.find("hand").value()].translation()), Vec3(2, 1, 0));
  EXPECT_EQ(Vec3(globals[skeleton.find("root").value()].translation()), Vec3(0, 1, 0.5));
  EXPECT_EQ(skeleton.joints[skeleton.find("hand").value()].parent, skeleton.find("arm"));
}

TEST(TemplateFile, NamesTheJointThatIsWrong) {
  EXPECT_NE(whatOf("{").find("byte"), std::string::npos);
  EXPECT_NE(whatOf("{}").find("has no joint"), std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": []})").find("has no joint"), std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": [{"position": [0, 0, 0]}]})").find("joint 0: has no name"), std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": [{"name": "tail", "position": [0, 0]}]})").find("tail: has no position"),
            std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": [{"name": "a", "position": [0, 0, 0]}, {"name": "a", "position": [0, 1, 0]}]})")
                .find("a: two joints"),
            std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": [{"name": "a", "parent": "ghost", "position": [0, 0, 0]}]})").find("'ghost'"),
            std::string::npos);
  EXPECT_NE(whatOf(R"({"joints": [{"name": "a", "parent": "b", "position": [0, 0, 0]},
                                  {"name": "b", "parent": "a", "position": [0, 1, 0]}]})")
                .find("cycle"),
            std::string::npos);
}

TEST(TemplateFile, RefusesAFileThatIsNotThere) {
  EXPECT_THROW(readTemplateFile("/nowhere/template.json"), Error);
  EXPECT_THROW(readTemplateFile("/nowhere/template.glb"), Error);
}

TEST(TemplateFile, BytesAreReadByTheirName) {
  const std::string_view json = R"({"joints": [{"name": "root", "position": [0, 1, 0]}]})";
  EXPECT_EQ(readTemplateFile(asBytes(json), "own.json").joints[0].name, "root");
  const std::string_view bvh =
      "HIERARCHY\nROOT hips\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 "
      "0\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.1\n0 0 0\n";
  EXPECT_EQ(readTemplateFile(asBytes(bvh), "own.bvh").joints[0].name, "hips");
  for (const char* name : {"own.json", "own.bvh", "own.glb"}) {
    try {
      readTemplateFile(asBytes("nothing"), name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.where().rfind(name, 0), 0u) << error.what();
      EXPECT_EQ(error.where().find(name, 1), std::string::npos) << error.what();
    }
  }
}

TEST(TemplateFile, AnErrorKeepsItsKind) {
  try {
    readTemplateFile(asBytes(""), "own.glb");
    ADD_FAILURE() << "an empty file is read";
  } catch (const KnownError& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kEmptyFile);
  }
}

}  // namespace limber
