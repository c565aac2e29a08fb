#include "limber/core/progress.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(Progress, TellsStagesAndFractionsAndKeepsTheTimes) {
  std::vector<std::pair<std::string, double>> told;
  Progress progress([&](std::string_view stage, double fraction) { told.emplace_back(stage, fraction); });
  progress.stage("weld");
  progress.update(0.5);
  progress.stage("rig");
  progress.finish();
  const std::vector<std::pair<std::string, double>> expected = {
      {"weld", 0}, {"weld", 0.5}, {"weld", 1}, {"rig", 0}, {"rig", 1}};
  EXPECT_EQ(told, expected);
  ASSERT_EQ(progress.stages().size(), 2u);
  EXPECT_EQ(progress.stages()[1].name, "rig");
  EXPECT_GE(progress.stages()[0].seconds, 0);
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
