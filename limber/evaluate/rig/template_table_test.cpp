#include "limber/evaluate/rig/template_table.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

using ::testing::HasSubstr;

TEST(LabelledFiles, ColumnsMayComeInAnyOrder) {
  const std::vector<LabelledFile> files =
      parseLabelledFiles("split\tbytes\tpath\tkind\r\ntune\t12\ta/one.glb\tchibi\r\ncheck\t13\ttwo.glb\tfish\r\n\r\n");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].path, "a/one.glb");
  EXPECT_EQ(files[0].kind, "chibi");
  EXPECT_EQ(files[1].split, "check");
  EXPECT_EQ(files[1].kind, "fish");
}

TEST(LabelledFiles, AColumnThatIsNotThereIsNamed) {
  try {
    parseLabelledFiles("path\tkind\none.glb\tfish\n");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.message(), HasSubstr("'split'"));
  }
}

TemplateTrial trial(const char* kind, RigFit fit, double jointToJoint) {
  TemplateTrial result;
  result.file = {std::string(kind) + ".glb", kind, "check"};
  result.row.fit = std::move(fit);
  result.row.comparison.withoutFingers.jointToJoint = jointToJoint;
  return result;
}

TEST(TemplateTables, CountKindsAndWhatIsSureAndWrong) {
  const std::vector<TemplateTrial> trials = {
      trial("chibi", {false, "humanoid-fingers", 0.9}, 3),  // right
      trial("chibi", {false, "humanoid", 0.85}, 9),         // right kind, far off
      trial("bird", {false, "humanoid", 0.7}, 4),           // wrong kind
      trial("bird", {true, "bird", 0.3}, 5),                // abstains where there is a template
      trial("blob", {true, "bird", 0.3}, 6),                // abstains where there is none
  };
  const std::string tables = toMarkdown(templateTables(trials));
  EXPECT_THAT(tables, HasSubstr("| kind told right | 3 of 5 (60 %;"));
  EXPECT_THAT(tables, HasSubstr("| a template is taken | 3 of 5 (60 %;"));
  EXPECT_THAT(tables, HasSubstr("| of these wrong (kind, or J2J above 8 %) | 2 of 3 (67 %;"));
  EXPECT_THAT(tables, HasSubstr("| of handles | 5.50 (6.00) |"));
  EXPECT_THAT(tables, HasSubstr("| 0.2 to 0.4 | 1 of 2 (50 %;"));
  EXPECT_THAT(tables, HasSubstr("| 0.8 to 1.0 | 2 of 2 (100 %; 34 to 100)"));
  EXPECT_THAT(tables, HasSubstr("| bird | 1 | 1 |")) << "one by handles, one taken for a person";
  EXPECT_THAT(toTsv(eachTemplateTrial(trials)), HasSubstr("bird.glb\tcheck\tbird\thumanoid\t0.700\t0\t0\t4.00"));
}

TEST(RiggerTable, HasALineForEachGroupAndRigger) {
  const auto riggerTrial = [](const char* rigger, const char* group, const char* file, double distance, double inside) {
    RiggerTrial result{rigger, group, {}, inside};
    result.row.path = file;
    RigDistances& distances = result.row.comparison.withoutFingers;
    distances.jointToJoint = distance;
    distances.joints = 30;
    distances.truthJoints = 20;
    result.row.seconds = 0.5;
    return result;
  };
  const std::string table = toMarkdown(riggerTable(
      std::vector<RiggerTrial>{riggerTrial("a", "tune", "1.glb", 2, 1), riggerTrial("a", "tune", "2.glb", 4, 0.5),
                               riggerTrial("a", "check", "3.glb", 7, 1), riggerTrial("b", "tune", "1.glb", 9, 0),
                               riggerTrial("b", "tune", "2.glb", 9, 0), riggerTrial("b", "check", "3.glb", 5, 0)}));
  EXPECT_THAT(table, HasSubstr("| tune (2) | a | 1.50 | 3.00 | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 0.75 | 0.50 |"));
  EXPECT_THAT(table, HasSubstr("| tune (2) | b | 1.50 | 9.00 |"));
  EXPECT_THAT(table, HasSubstr("| check (1) | a | 1.50 | 7.00 |"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
  // A file that one rigger could not do counts for none.
  const std::string common = toMarkdown(riggerTable(
      std::vector<RiggerTrial>{riggerTrial("a", "tune", "1.glb", 2, 1), riggerTrial("a", "tune", "2.glb", 4, 0.5),
                               riggerTrial("b", "tune", "1.glb", 9, 0), riggerTrial("a", "check", "3.glb", 7, 1)}));
  EXPECT_THAT(common, HasSubstr("| tune (1) | a | 1.50 | 2.00 |"));
  EXPECT_THAT(common, HasSubstr("| tune (1) | b | 1.50 | 9.00 |"));
  EXPECT_EQ(std::count(common.begin(), common.end(), '\n'), 4);
}

}  // namespace
}  // namespace limber
