#include "limber/study/ranking/study_rankings.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::ElementsAre;

// One cell with a value of `measure`.
void addValue(StudyResult& study, const std::string& group, const std::string& rigger, const std::string& measure,
              double value) {
  StudyCell cell;
  cell.group = group;
  cell.model = "model " + std::to_string(study.cells.size());
  cell.rigger = rigger;
  cell.skinning = "bone-heat";
  cell.steps = {{"evaluate", {}, findMeasure(measure).source}};
  study.cells.push_back(cell);
  study.results.emplace_back().measures = {{&findMeasure(measure), value}};
}

// The group's rankings are those of rankMethods, at indices that are the same in each group.
TEST(StudyRankings, AreOverAllAndInEachFolder) {
  StudyResult study;
  addValue(study, "people", "template", "joint_to_joint", 3);
  addValue(study, "animals", "sphere-mesh", "joint_to_joint", 5);
  addValue(study, "people", "own", "volume_loss", 0.5);
  const std::vector<KindRankings> kinds = studyRankings(study);
  ASSERT_EQ(kinds.size(), 1u);
  EXPECT_EQ(kinds[0].kind, CellKind::kRig);
  EXPECT_THAT(kinds[0].methods, ElementsAre("template + bone-heat", "sphere-mesh + bone-heat", "own + bone-heat"));
  ASSERT_EQ(kinds[0].groups.size(), 3u);
  EXPECT_EQ(kinds[0].groups[0].name, "");
  EXPECT_EQ(kinds[0].groups[1].name, "people");
  EXPECT_EQ(kinds[0].groups[2].name, "animals");
  for (const GroupRankings& group : kinds[0].groups) {
    ASSERT_EQ(group.rankings.size(), 2u);
    EXPECT_EQ(group.rankings[0].measure->name, "joint_to_joint");
    EXPECT_EQ(group.rankings[1].measure->name, "volume_loss");
  }
  const GroupRankings& animals = kinds[0].groups[2];
  EXPECT_EQ(animals.rankings[0].scoreOf("sphere-mesh + bone-heat")->value.median, 5);
  EXPECT_FALSE(animals.rankings[0].scoreOf("template + bone-heat"));
  EXPECT_TRUE(animals.rankings[1].scores.empty());
}

TEST(StudyRankings, OneFolderIsAll) {
  StudyResult study;
  addValue(study, "people", "template", "joint_to_joint", 3);
  EXPECT_EQ(studyRankings(study).at(0).groups.size(), 1u);
}

// How many joints there are has no better side.
TEST(StudyRankings, WithoutAMeasureThereAreNone) {
  StudyResult study;
  EXPECT_TRUE(studyRankings(study).empty());
  addValue(study, "people", "template", "joints", 22);
  EXPECT_TRUE(studyRankings(study).empty());
}

TEST(StudyRankings, NumbersOfFailuresAreWords) {
  EXPECT_EQ(numberText(3.125), "3.125");
  EXPECT_EQ(numberText(std::numeric_limits<double>::infinity()), "failed");
}

}  // namespace
}  // namespace limber
