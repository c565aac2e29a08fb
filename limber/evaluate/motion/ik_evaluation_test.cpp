#include "limber/evaluate/motion/ik_evaluation.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(IkEvaluation, ProblemsAreTheSameForTheSameSeedAndOfTheirKind) {
  const std::vector<IkProblemSet> once = ikProblemSets(3, 7), again = ikProblemSets(3, 7), other = ikProblemSets(3, 8);
  ASSERT_EQ(once.size(), 4u * 6 + 5 + 2);
  for (std::size_t s = 0; s < once.size(); ++s) {
    ASSERT_EQ(once[s].problems.size(), 3u);
    const IkProblemSet& set = once[s];
    for (std::size_t i = 0; i < 3; ++i) {
      const IkProblem& problem = set.problems[i];
      EXPECT_EQ(problem.targets[0].position, again[s].problems[i].targets[0].position);
      EXPECT_NE(problem.targets[0].position, other[s].problems[i].targets[0].position);
      for (Index j = 0; j < set.skeleton.jointCount(); ++j) {
        EXPECT_LT(limitViolation(set.limits.joints[j], problem.start.locals[j].rotation), 1e-6) << set.name;
      }
      const double distance = problem.targets[0].position.norm();
      if (set.name.rfind("chain", 0) == 0) {
        EXPECT_EQ(distance > 0.9001, set.reach == IkReach::kUnreachable) << set.name;
      }
    }
  }
}

TEST(IkEvaluation, ScoresWhatMethodsDo) {
  IkEvaluationOptions options;
  options.problems = 5;
  options.methods = {"two-bone", "dls"};
  Progress progress;
  const std::vector<IkScore> scores = evaluateIk(options, progress);
  ASSERT_EQ(scores.size(), 31u + 6u + 1u) << "two-bone on chains of three joints and by itself";
  for (const IkScore& score : scores) {
    EXPECT_EQ(score.problems, 5u);
    EXPECT_LE(score.medianMicros, score.percentile99Micros);
    EXPECT_LT(score.worstViolation, 1e-4) << score.set;
    if (score.limited || score.method == "two-bone") continue;
    EXPECT_EQ(score.solved, 5u) << score.set;
  }
  const IkScore* closedForm = findIkScore(scores, "two-bone", kClosedFormSet);
  ASSERT_NE(closedForm, nullptr);
  EXPECT_EQ(closedForm->solved, 5u);
  EXPECT_EQ(bestIkMethodWithLimits(scores), "dls");
  EXPECT_NE(toMarkdown(ikScoreTable(scores)).find("| chain-10 reachable | dls | 100.0 % |"), std::string::npos);
  EXPECT_EQ(toJson(scores)["best_with_limits"], "dls");
}

TEST(IkEvaluation, UnknownMethodsAreRefused) {
  IkEvaluationOptions options;
  options.methods = {"magic"};
  Progress progress;
  EXPECT_THROW(evaluateIk(options, progress), Error);
}

}  // namespace
}  // namespace limber
