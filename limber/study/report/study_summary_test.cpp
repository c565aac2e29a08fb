#include "limber/study/report/study_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

// Cells of one method over models of two folders in turn; none: it failed there.
void addCells(StudyResult& study, const std::string& rigger, const std::vector<std::optional<double>>& distances,
              double seconds = 1.5) {
  for (std::size_t i = 0; i < distances.size(); ++i) {
    StudyCell cell;
    cell.model = "model " + std::to_string(i);
    cell.group = i % 2 == 0 ? "people" : "animals";
    cell.rigger = rigger;
    cell.skinning = "bone-heat";
    cell.steps = {{"rig", {}, MeasureSource::kRigReport, {}, {}, true},
                  {"evaluate rig", {}, MeasureSource::kSkeletonTruth},
                  {"evaluate model", {}, MeasureSource::kModel}};
    CellResult result;
    if (distances[i]) {
      result.measures = {{&findMeasure("seconds"), seconds},
                         {&findMeasure("joint_to_joint"), *distances[i]},
                         {&findMeasure("volume_loss"), *distances[i] / 100}};
    } else {
      result.outcome = JobOutcome::kFailed;
    }
    study.cells.push_back(cell);
    study.results.push_back(result);
  }
}

StudyResult twoMethods(double seconds = 1.5) {
  StudyResult study;
  study.title = "Two methods";
  addCells(study, "template", {1, 2, 3, 4, 5, 6, 7, 8}, seconds);
  addCells(study, "sphere-mesh", {2, 3, 4, 5, 6, 7, 9, std::nullopt}, seconds);
  return study;
}

// By hand: of 1 to 8 the median is 4.5; eight of eight differences to one side have p = 2 / 256.
TEST(StudySummary, HasMediansIntervalsFailuresAndWhoIsAhead) {
  const std::string text = studySummary(twoMethods());
  EXPECT_THAT(text,
              AllOf(HasSubstr("# Two methods\n\n16 cells."), HasSubstr("## Rigs: all models\n"),
                    HasSubstr("### Skeletons against the artist's\n\n| method | joints to artist's joints (% of the "
                              "longest side; less is better) | time (s) |\n| --- | --- | --- |\n"),
                    HasSubstr("| template + bone-heat | 4.5 ("), HasSubstr("| sphere-mesh + bone-heat | 5.5 ("),
                    HasSubstr("), 1 of 8 failed | 1.5 |\n"),
                    HasSubstr("- joints to artist's joints: template + bone-heat before sphere-mesh + bone-heat "
                              "on 8 of 8, behind on 0, p = 0.008\n"),
                    HasSubstr("## Rigs: cells that did not end well\n\n- sphere-mesh + bone-heat: 1 of 8\n")));
}

TEST(StudySummary, FoldersHaveTablesOfTheirOwn) {
  const std::string text = studySummary(twoMethods());
  const std::size_t all = text.find("## Rigs: all models"), people = text.find("## Rigs: people"),
                    animals = text.find("## Rigs: animals");
  ASSERT_NE(animals, std::string::npos);
  EXPECT_LT(all, people);
  EXPECT_LT(people, animals);
  // Four models each: p is 1/8 at the least.
  EXPECT_THAT(text.substr(people, animals - people), HasSubstr("No two methods are told apart.\n"));
}

TEST(StudySummary, WhatRanksNothingIsShownWithoutWords) {
  const std::string text = studySummary(twoMethods());
  const std::size_t begin = text.find("### The surface in motion (ranks nothing)");
  ASSERT_NE(begin, std::string::npos);
  const std::string part = text.substr(begin, text.find("## Rigs: people") - begin);
  EXPECT_THAT(part, AllOf(HasSubstr("| template + bone-heat | 0.045 ("), Not(HasSubstr("told apart"))));
}

TEST(StudySummary, WithoutTimesItDoesNotDependOnThem) {
  const SummaryOptions withoutTimes{false};
  EXPECT_EQ(studySummary(twoMethods(1.5), withoutTimes), studySummary(twoMethods(20), withoutTimes));
  EXPECT_NE(studySummary(twoMethods(1.5)), studySummary(twoMethods(20)));
  EXPECT_THAT(studySummary(twoMethods(), withoutTimes), Not(HasSubstr("time")));
}

TEST(StudySummary, MethodsWithoutAMeasureAreNotInItsTable) {
  StudyResult study = twoMethods();
  StudyCell cell = study.cells[0];
  cell.rigger = "own";
  cell.steps = {{"evaluate weights", {}, MeasureSource::kWeightTruth}};
  study.cells.push_back(cell);
  study.results.emplace_back().measures = {{&findMeasure("weight_l1"), 0.25}};
  const std::string text = studySummary(study);
  const std::size_t weights = text.find("### Weights against the artist's");
  ASSERT_NE(weights, std::string::npos);
  EXPECT_THAT(text.substr(0, weights), Not(HasSubstr("own + bone-heat")));
  EXPECT_THAT(text.substr(weights), HasSubstr("| own + bone-heat | 0.25 (0.25 to 0.25) | - |\n"));
}

TEST(StudySummary, EscapesWhateverComesOutOfFiles) {
  StudyResult study = twoMethods();
  study.title = "a|b\n# <c>";
  for (StudyCell& cell : study.cells) cell.options = "*x*|`y`\xff";
  const std::string text = studySummary(study);
  EXPECT_THAT(text, AllOf(HasSubstr("# a\\|b \\# \\<c\\>\n"), HasSubstr("\\*x\\*\\|\\`y\\`"), Not(HasSubstr("\xff"))));
}

TEST(StudySummary, AStudyWithoutCellsHasATitle) {
  StudyResult study;
  study.title = "Nothing";
  EXPECT_THAT(studySummary(study), HasSubstr("# Nothing\n\n0 cells."));
}

}  // namespace
}  // namespace limber
