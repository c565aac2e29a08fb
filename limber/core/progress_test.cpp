#include "limber/core/progress.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(Progress, TellsStagesAndFractionsAndKeepsTheTimes) {
  std::vector<std::pair<std::string, double>> reported;
  Progress progress([&](std::string_view stage, double fraction) { reported.emplace_back(stage, fraction); });
  progress.stage("weld");
  progress.update(0.5);
  progress.stage("rig");
  progress.finish();
  const std::vector<std::pair<std::string, double>> expected = {
      {"weld", 0}, {"weld", 0.5}, {"weld", 1}, {"rig", 0}, {"rig", 1}};
  EXPECT_EQ(reported, expected);
  ASSERT_EQ(progress.stages().size(), 2u);
  EXPECT_EQ(progress.stages()[1].name, "rig");
  EXPECT_GE(progress.stages()[0].seconds, 0);
}

TEST(Progress, StepsLieWithinTheirStage) {
  std::vector<std::pair<std::string, double>> reported;
  Progress progress([&](std::string_view stage, double fraction) { reported.emplace_back(stage, fraction); });
  progress.stage("skin");
  progress.step("factorise");
  progress.update(0.5);
  progress.step("solve");
  progress.stage("write");
  progress.finish();
  const std::vector<std::pair<std::string, double>> expected = {{"skin", 0},
                                                                {"skin: factorise", 0},
                                                                {"skin: factorise", 0.5},
                                                                {"skin: factorise", 1},
                                                                {"skin: solve", 0},
                                                                {"skin: solve", 1},
                                                                {"skin", 1},
                                                                {"write", 0},
                                                                {"write", 1}};
  EXPECT_EQ(reported, expected);
  ASSERT_EQ(progress.stages().size(), 2u);
  const StageTime& skin = progress.stages()[0];
  ASSERT_EQ(skin.steps.size(), 2u);
  EXPECT_EQ(skin.steps[1].name, "solve");
  EXPECT_GE(skin.seconds, skin.steps[0].seconds + skin.steps[1].seconds);
  EXPECT_TRUE(progress.stages()[1].steps.empty());
}

TEST(Progress, AStepOutsideOfAStageIsKeptToo) {
  Progress progress;
  progress.step("solve");
  progress.step("bridge");
  progress.finish();
  ASSERT_EQ(progress.stages().size(), 1u);
  EXPECT_EQ(progress.stages()[0].steps.size(), 2u);
}

TEST(Progress, CancelLeavesThroughTheNextCall) {
  Progress progress;
  progress.stage("weld");
  EXPECT_NO_THROW(progress.update(0.1));
  progress.cancel();
  try {
    progress.update(0.2);
    FAIL() << "went on after cancel()";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  }
  EXPECT_THROW(progress.stage("rig"), Error);
}

}  // namespace
}  // namespace limber
