// Loops, root motion and fewer keys, as a user runs them.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class CliClips : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ASSERT_EQ(run({"sample", "walk", "-o", "walk.bvh", "-q"}).code, 0);
    ASSERT_EQ(run({"sample", "run", "-o", "run.bvh", "-q"}).code, 0);
  }
  nlohmann::json info(const char* name) { return nlohmann::json::parse(run({"info", name, "--json"}).out); }
};

TEST_F(CliClips, ConvertMakesALoopWithARootJointAndFewKeys) {
  ASSERT_EQ(run({"convert", "run.bvh", "plain.glb", "-q"}).code, 0);
  const Result done =
      run({"convert", "run.bvh", "game.glb", "--loop", "--root-joint", "--root-motion", "xz+turn", "--tolerance", "1"});
  ASSERT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(done.out, AllOf(HasSubstr("loops from"), HasSubstr("joined"), HasSubstr("keys, at most")));
  EXPECT_THAT(info("game.glb").at("joint_names").dump(), HasSubstr("\"root\""));
  EXPECT_EQ(info("game.glb").at("joints").get<int>(), info("plain.glb").at("joints").get<int>() + 1);
  EXPECT_LT(content("game.glb").size(), content("plain.glb").size());
  keep("game.glb");
  EXPECT_EQ(run({"convert", "game.glb", "game.bvh", "-q"}).code, 0);
  EXPECT_THAT(content("game.bvh"), HasSubstr("ROOT root"));
}

TEST_F(CliClips, ABvhGetsARootJointToo) {
  ASSERT_EQ(run({"convert", "walk.bvh", "rooted.bvh", "--root-joint=Ground", "-q"}).code, 0);
  EXPECT_THAT(content("rooted.bvh"), HasSubstr("ROOT Ground"));
}

TEST_F(CliClips, AMotionIsWrittenForATargetToo) {
  for (const char* file : {"unreal.glb", "unreal.fbx"}) {
    const Result done = run({"convert", "walk.bvh", file, "--target", "unreal", "-q"});
    ASSERT_EQ(done.code, 0) << done.error;
    // Not matched as a whole: where it differs a whole file would be printed.
    for (const char* name : {"root", "pelvis", "thigh_l"})
      EXPECT_NE(content(file).find(name), std::string::npos) << file << ": " << name;
  }
  keep("unreal.glb");
  ASSERT_EQ(run({"convert", "unreal.fbx", "mixamo.bvh", "--target", "mixamo", "-q"}).code, 0);
  EXPECT_THAT(content("mixamo.bvh"), HasSubstr("mixamorig:LeftUpLeg"));
  const Result vrma = run({"convert", "walk.bvh", "walk.vrma", "--target", "unreal"});
  EXPECT_NE(vrma.code, 0);
  EXPECT_THAT(vrma.error, HasSubstr("--target"));
  ASSERT_EQ(run({"convert", "walk.bvh", "walk.vrma", "-q"}).code, 0);
  ASSERT_EQ(run({"convert", "walk.vrma", "back.bvh", "--target", "actorcore", "-q"}).code, 0);
  EXPECT_NE(content("back.bvh").find("JOINT CC_Base_L_Thigh"), std::string::npos);
}

TEST_F(CliClips, RetargetTakesTheSameOptions) {
  ASSERT_EQ(run({"sample", "biped", "-o", "biped.glb", "-q"}).code, 0);
  const Result done = run({"animate", "biped.glb", "walk.bvh", "-o", "walking.glb", "--in-place", "--tolerance", "2"});
  ASSERT_EQ(done.code, 0) << done.error;
  EXPECT_THAT(done.out, HasSubstr("keys, at most"));
  EXPECT_THAT(info("walking.glb").at("joint_names").dump(), Not(HasSubstr("\"root\"")));
  keep("walking.glb");
  const Result rooted = run({"retarget", "walking.glb", "walk.bvh", "-o", "both.glb", "--root-joint=mover", "-q"});
  ASSERT_EQ(rooted.code, 0) << rooted.error;
  EXPECT_THAT(info("both.glb").at("joint_names").dump(), HasSubstr("\"mover\""));
  EXPECT_EQ(info("both.glb").at("clips").size(), 2);
  keep("both.glb");
}

TEST_F(CliClips, WhatMakesNoSenseIsOneLine) {
  const std::vector<std::string> before = files();
  for (std::vector<std::string> call : {std::vector<std::string>{"walk.bvh", "a.bvh", "--tolerance", "1"},
                                        {"walk.bvh", "a.glb", "--tolerance", "0"},
                                        {"walk.bvh", "a.glb", "--tolerance", "nan"},
                                        {"walk.bvh", "a.glb", "--root-motion", "xyz"},
                                        {"walk.bvh", "a.glb", "--in-place", "--root-joint"},
                                        {"walk.bvh", "a.glb", "--in-place", "--root-motion", "sideways"},
                                        {"walk.bvh", "a.glb", "--in-place", "--root-smoothing", "-1"}}) {
    call.insert(call.begin(), "convert");
    const Result refused = run(call);
    EXPECT_NE(refused.code, 0) << call.back();
  }
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace limber
