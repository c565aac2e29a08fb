#include "limber/evaluate/motion/judge_table.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(JudgeTable, HalvesAndMethodsHaveColumns) {
  RetargetScore score;
  score.method = "limb-ik";
  score.verdict.emplace();
  score.verdict->jerk = 1.25;
  RetargetScore other = score;
  other.heldOut = true;
  other.verdict->jerk = 1.5;
  const std::string table = toMarkdown(judgeTables(std::vector{score, other}, {}));
  EXPECT_NE(table.find("| limb-ik, set by | limb-ik, held out |"), std::string::npos);
  EXPECT_NE(table.find("| 1.25 (1.25) | 1.50 (1.50) |"), std::string::npos) << table;
}

}  // namespace
}  // namespace limber
