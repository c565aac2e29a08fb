#include "limber/study/ranking/method_ranking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "limber/core/error.h"
#include "limber/study/report/time_plot.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// A cell of `method` for each value; none: it failed.
void addMethod(StudyResult& study, const std::string& method, const std::string& measure,
               const std::vector<std::optional<double>>& values, double seconds = 1) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    StudyCell cell;
    cell.model = "model " + std::to_string(i);
    cell.group = i % 2 == 0 ? "even" : "odd";
    cell.rigger = method;
    cell.steps = {{"rig", {}, MeasureSource::kRigReport, {}, {}, true}, {"evaluate", {}, findMeasure(measure).source}};
    CellResult result;
    if (values[i]) {
      result.measures = {{&findMeasure("seconds"), seconds}, {&findMeasure(measure), *values[i]}};
    } else {
      result.outcome = JobOutcome::kCrashed;
    }
    study.cells.push_back(cell);
    study.results.push_back(result);
  }
}

std::vector<std::string> methodsOf(const Ranking& ranking) {
  std::vector<std::string> names;
  for (const MethodScore& score : ranking.scores) names.push_back(score.method.substr(0, score.method.find(' ')));
  return names;
}

TEST(Ranking, TheBetterMedianComesFirst) {
  StudyResult study;
  addMethod(study, "bad", "joint_to_joint", {5, 6, 7, 8, 9, 10});
  addMethod(study, "good", "joint_to_joint", {1, 2, 3, 4, 5, 6});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"));
  EXPECT_THAT(methodsOf(ranking), ElementsAre("good", "bad"));
  EXPECT_EQ(ranking.scores[0].value.median, 3.5);
  EXPECT_LE(ranking.scores[0].value.low, 3.5);
  EXPECT_GE(ranking.scores[0].value.high, 3.5);
  ASSERT_EQ(ranking.pairs.size(), 1u);
  EXPECT_EQ(ranking.pairs[0].firstWins, 6u);
  EXPECT_EQ(ranking.pairs[0].secondWins, 0u);
  EXPECT_NEAR(ranking.pairs[0].p, 2 / 64.0, 1e-12);
  EXPECT_EQ(ranking.worstCells.front(), 5u);
  EXPECT_EQ(ranking.worstCells.size(), 10u);
}

TEST(Ranking, MoreIsBetterWhereTheMeasureSaysSo) {
  StudyResult study;
  addMethod(study, "low", "joint_iou", {0.1, 0.2, 0.3});
  addMethod(study, "high", "joint_iou", {0.7, 0.8, 0.9});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("joint_iou"));
  EXPECT_THAT(methodsOf(ranking), ElementsAre("high", "low"));
  EXPECT_EQ(ranking.scores[0].value.median, 0.8);
  EXPECT_EQ(ranking.scores[0].value.low, 0.7);
  EXPECT_EQ(ranking.scores[0].value.high, 0.9);
  EXPECT_EQ(ranking.worstCells.front(), 0u);
}

TEST(Ranking, FailingOnHardModelsGainsNothing) {
  StudyResult study;
  addMethod(study, "brave", "joint_to_joint", {1, 2, 30, 40, 50});
  addMethod(study, "coward", "joint_to_joint", {0.5, 1, std::nullopt, std::nullopt, std::nullopt});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"));
  EXPECT_THAT(methodsOf(ranking), ElementsAre("brave", "coward"));
  EXPECT_EQ(ranking.scores[1].failures, 3u);
  EXPECT_EQ(ranking.scores[1].subjects, 5u);
  EXPECT_TRUE(std::isinf(ranking.scores[1].value.median));
  EXPECT_EQ(ranking.pairs[0].firstWins, 3u);
}

TEST(Ranking, ModelsThatNoMethodManagesDoNotCount) {
  StudyResult study;
  addMethod(study, "one", "joint_to_joint", {1, std::nullopt, 3});
  addMethod(study, "two", "joint_to_joint", {2, std::nullopt, 4});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"));
  EXPECT_EQ(ranking.scores[0].subjects, 2u);
  EXPECT_EQ(ranking.scores[0].failures, 0u);
}

TEST(Ranking, IsOfOneGroupOnDemand) {
  StudyResult study;
  addMethod(study, "one", "joint_to_joint", {1, 9, 1, 9});
  addMethod(study, "two", "joint_to_joint", {2, 2, 2, 2});
  EXPECT_THAT(methodsOf(rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"), "even")),
              ElementsAre("one", "two"));
  EXPECT_THAT(methodsOf(rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"), "odd")),
              ElementsAre("two", "one"));
}

TEST(Ranking, IsEmptyWhereNothingWasMeasured) {
  StudyResult study;
  addMethod(study, "one", "joint_to_joint", {1});
  EXPECT_TRUE(rankMethods(study, CellKind::kRig, findMeasure("weight_l1")).scores.empty());
  EXPECT_TRUE(rankMethods(study, CellKind::kRetarget, findMeasure("joint_to_joint")).scores.empty());
  EXPECT_TRUE(rankMethods({}, CellKind::kRig, findMeasure("joint_to_joint")).scores.empty());
  EXPECT_THROW(rankMethods(study, CellKind::kRig, findMeasure("joints")), Error);
}

// Many small wins and few large losses: the test is about ranks, not about counts.
TEST(Ranking, TheTestsSideIsNotThatOfTheWins) {
  StudyResult study;
  std::vector<std::optional<double>> even(21, 10.0), other;
  for (int i = 0; i < 12; ++i) other.push_back(10.001 + 0.001 * i);
  for (int i = 0; i < 9; ++i) other.push_back(1.0 - 0.01 * i);
  addMethod(study, "even", "joint_to_joint", even);
  addMethod(study, "other", "joint_to_joint", other);
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint"));
  ASSERT_EQ(ranking.pairs.size(), 1u);
  const MethodPair& pair = ranking.pairs[0];
  EXPECT_EQ(pair.first, "even " + ranking.pairs[0].first.substr(5));
  EXPECT_GT(pair.firstWins, pair.secondWins);
  EXPECT_TRUE(pair.isTurned);
}

TEST(Ranking, WhatRanksNothingKeepsTheOrderOfTheStudy) {
  ASSERT_FALSE(findMeasure("volume_loss").ranks);
  StudyResult study;
  addMethod(study, "bad", "volume_loss", {5, 6, 7});
  addMethod(study, "good", "volume_loss", {1, 2, 3});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("volume_loss"));
  EXPECT_THAT(methodsOf(ranking), ElementsAre("bad", "good"));
  EXPECT_EQ(ranking.scores[1].value.median, 2);
  EXPECT_TRUE(ranking.pairs.empty());
  EXPECT_TRUE(ranking.worstCells.empty());
}

// Cells of one rigger with several skinning methods.
void addSkinning(StudyResult& study, const std::string& rigger, const std::string& skinning,
                 const std::vector<double>& values) {
  const std::size_t first = study.cells.size();
  addMethod(study, rigger, "stretch", {values.begin(), values.end()});
  for (std::size_t i = first; i < study.cells.size(); ++i) study.cells[i].skinning = skinning;
}

TEST(Ranking, MeasuresOfWeightsCompareThoseOnTheSameJoints) {
  ASSERT_TRUE(findMeasure("stretch").needsSameJoints);
  StudyResult study;
  addSkinning(study, "few joints", "stiff", {0, 0, 0});
  addSkinning(study, "own", "bad", {5, 6, 7});
  addSkinning(study, "own", "good", {1, 2, 3});
  const Ranking ranking = rankMethods(study, CellKind::kRig, findMeasure("stretch"));
  ASSERT_EQ(ranking.scores.size(), 2u);
  EXPECT_EQ(ranking.scores[0].method, "own + good");
  EXPECT_EQ(ranking.scores[1].method, "own + bad");
  // Options may tell how many joints there are.
  StudyResult counted = study;
  addSkinning(counted, "handles", "a", {1, 1, 1});
  addSkinning(counted, "handles", "b", {2, 2, 2});
  addSkinning(counted, "handles", "c", {3, 3, 3});
  for (std::size_t i = study.cells.size(); i < counted.cells.size(); ++i) {
    counted.cells[i].options = std::to_string(i / 3) + " of them";
  }
  EXPECT_EQ(rankMethods(counted, CellKind::kRig, findMeasure("stretch")).scores[0].method, "own + good");
  // Without two methods on the same joints there is nothing to compare.
  StudyResult apart;
  addSkinning(apart, "few joints", "stiff", {0, 0, 0});
  addSkinning(apart, "own", "good", {1, 2, 3});
  EXPECT_TRUE(rankMethods(apart, CellKind::kRig, findMeasure("stretch")).scores.empty());
}

TEST(TimePlot, HasAPointForEachMethodThatHasBoth) {
  StudyResult study;
  addMethod(study, "one", "joint_to_joint", {1, 2}, 0.5);
  addMethod(study, "two", "joint_to_joint", {3, 4}, 5);
  addMethod(study, "none", "joint_to_joint", {std::nullopt, std::nullopt});
  const std::string svg = timePlot(rankMethods(study, CellKind::kRig, findMeasure("joint_to_joint")));
  EXPECT_THAT(svg, HasSubstr(">1</text>"));
  EXPECT_THAT(svg, HasSubstr(">2</text>"));
  EXPECT_THAT(svg, Not(HasSubstr(">3</text>")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(timePlot(rankMethods(study, CellKind::kRig, findMeasure("seconds"))), "");
}

}  // namespace
}  // namespace limber
