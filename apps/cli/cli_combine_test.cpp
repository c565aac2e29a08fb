// Motions combined, through the program itself.
#include <nlohmann/json.hpp>

#include "testing/cli_fixture.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CliCombine : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    for (const char* name : {"walk", "run"}) {
      ASSERT_EQ(run({"sample", name, "-q", "-o", std::string(name) + ".bvh"}).code, 0);
    }
  }
  Result combine(std::vector<std::string> options, std::vector<std::string> motions = {"walk.bvh", "run.bvh"}) {
    std::vector<std::string> all = {"retarget", "walk.bvh"};  // a character with a clip of its own
    all.insert(all.end(), motions.begin(), motions.end());
    all.insert(all.end(), options.begin(), options.end());
    all.insert(all.end(), {"-o", "out.glb"});
    return run(all);
  }
  std::vector<std::string> clips() {
    std::vector<std::string> names;
    const nlohmann::json info = nlohmann::json::parse(run({"info", "out.glb", "--json"}).out);
    for (const nlohmann::json& clip : info.at("clips")) {
      names.push_back(clip.at("name"));
    }
    return names;
  }
};

TEST_F(CliCombine, ABlendIsOneClipCalledByItsWeight) {
  const Result result = combine({"--blend", "0.4"});
  ASSERT_EQ(result.code, 0) << result.error;
  EXPECT_THAT(result.out, HasSubstr("walk_run_0.40"));
  EXPECT_THAT(clips(), ElementsAre("walk", "walk_run_0.40"));
  keep("out.glb");
}

TEST_F(CliCombine, ASetOfBlendsIsAClipEach) {
  ASSERT_EQ(combine({"--blend", "0:1:3", "-q"}).code, 0);
  EXPECT_THAT(clips(), ElementsAre("walk", "walk_run_0.00", "walk_run_0.50", "walk_run_1.00"));
}

TEST_F(CliCombine, MotionsOneAfterTheOtherAreOneClip) {
  ASSERT_EQ(combine({"--crossfade", "0.4", "-q"}).code, 0);
  EXPECT_THAT(clips(), ElementsAre("walk", "walk_run"));
  ASSERT_EQ(combine({"--sequence", "-q"}, {"walk.bvh", "run.bvh", "walk.bvh"}).code, 0);
  EXPECT_THAT(clips(), ElementsAre("walk", "walk_run_walk"));
}

TEST_F(CliCombine, WhatIsTooShortIsToldOf) {
  const Result longer = combine({"--crossfade", "9"});
  ASSERT_EQ(longer.code, 0) << longer.error;
  EXPECT_THAT(longer.error, HasSubstr("too short for a transition of 9 s"));
  ASSERT_EQ(run({"convert", "walk.bvh", "-o", "short.bvh", "--trim", "0:0.1", "-q"}).code, 0);
  EXPECT_THAT(combine({"--sequence"}, {"short.bvh", "walk.bvh"}).error, HasSubstr("for a transition of 0.3 s"));
  EXPECT_THAT(combine({"--blend", "0.5"}, {"short.bvh", "walk.bvh"}).error, HasSubstr("differ by a factor of"));
}

TEST_F(CliCombine, WhatDoesNotGoTogetherIsOneLineAndLeavesNoFile) {
  const std::vector<std::string> before = files();
  EXPECT_THAT(combine({"--blend", "0.5", "--sequence"}).error, AllOf(HasSubstr("--blend"), HasSubstr("--sequence")));
  EXPECT_THAT(combine({"--blend", "1.5"}).error, HasSubstr("0 to 1"));
  EXPECT_THAT(combine({"--blend", "0:1:"}).error, HasSubstr("FROM:TO:COUNT"));
  EXPECT_THAT(combine({"--blend", "0:1:1"}).error, HasSubstr("count"));
  EXPECT_THAT(combine({"--crossfade", "0.3"}, {"walk.bvh", "run.bvh", "walk.bvh"}).error, HasSubstr("--sequence"));
  const Result alone = combine({"--blend", "0.5"}, {"walk.bvh"});
  expectOneLine(alone, 1);
  EXPECT_THAT(alone.error, AllOf(HasSubstr("two clips, not 1"), HasSubstr("convert --clip")));
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace limber
