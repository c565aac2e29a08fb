#include "limber/rigging/decomposition/convex_weights.h"

#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "limber/core/random.h"

namespace limber {
namespace {

using Dense = Eigen::MatrixXd;

// Of `bones` random columns of `rows` numbers and a target that is no mixture of them.
WeightProblem randomProblem(Random& random, int bones, int rows) {
  Dense columns(rows, bones);
  Eigen::VectorXd target(rows);
  for (int r = 0; r < rows; ++r) {
    for (int b = 0; b < bones; ++b) columns(r, b) = random.uniform(-1, 1);
    target[r] = random.uniform(-1, 1);
  }
  WeightProblem problem;
  problem.gram = columns.transpose() * columns;
  problem.linear = columns.transpose() * target;
  return problem;
}

// The least value over all supports of at most `most` bones, each solved as a dense system with a multiplier for the
// sum; supports with a negative weight are no solutions.
double bruteForce(const WeightProblem& problem, int most) {
  const int count = static_cast<int>(problem.linear.size());
  double best = std::numeric_limits<double>::infinity();
  for (int mask = 1; mask < 1 << count; ++mask) {
    std::vector<int> members;
    for (int b = 0; b < count; ++b) {
      if (mask >> b & 1) members.push_back(b);
    }
    const int size = static_cast<int>(members.size());
    if (size > most) continue;
    Dense system = Dense::Zero(size + 1, size + 1);
    Eigen::VectorXd right = Eigen::VectorXd::Ones(size + 1);
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) system(i, j) = problem.gram(members[i], members[j]);
      system(i, size) = system(size, i) = 1;
      right[i] = problem.linear[members[i]];
    }
    const Eigen::VectorXd solved = system.partialPivLu().solve(right);
    if ((solved.head(size).array() < 0).any()) continue;
    WeightProblem::Vector weights = WeightProblem::Vector::Zero(count);
    for (int i = 0; i < size; ++i) weights[members[i]] = solved[i];
    best = std::min(best, problem.value(weights));
  }
  return best;
}

void expectConvex(const WeightProblem::Vector& weights, Index most) {
  EXPECT_NEAR(weights.sum(), 1, 1e-9);
  EXPECT_GE(weights.minCoeff(), 0);
  EXPECT_LE((weights.array() > 0).count(), most);
}

TEST(ConvexWeights, AreTheBestOfAllSupports) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const int bones = 1 + trial % 7;
    const WeightProblem problem = randomProblem(random, bones, 12);
    const WeightProblem::Vector weights = sparseConvexWeights(problem, static_cast<Index>(bones));
    expectConvex(weights, static_cast<Index>(bones));
    EXPECT_NEAR(problem.value(weights), bruteForce(problem, bones), 1e-8) << trial;
  }
}

TEST(ConvexWeights, OfFewInfluencesAreTheBestOfTheirSupportAndNearTheBestOfAll) {
  Random random(2);
  int same = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const WeightProblem problem = randomProblem(random, 7, 12);
    const WeightProblem::Vector weights = sparseConvexWeights(problem, 2);
    expectConvex(weights, 2);
    WeightProblem own;
    std::vector<int> members;
    for (int b = 0; b < 7; ++b) {
      if (weights[b] > 0) members.push_back(b);
    }
    own.gram.resize(members.size(), members.size());
    own.linear.resize(members.size());
    for (std::size_t i = 0; i < members.size(); ++i) {
      own.linear[i] = problem.linear[members[i]];
      for (std::size_t j = 0; j < members.size(); ++j) own.gram(i, j) = problem.gram(members[i], members[j]);
    }
    const double value = problem.value(weights), least = bruteForce(problem, 2);
    EXPECT_NEAR(value, bruteForce(own, 2), 1e-8) << trial;
    EXPECT_GE(value, least - 1e-8);
    same += value <= least + 1e-8;
  }
  EXPECT_GT(same, 9 * kTrials / 10);
}

TEST(ConvexWeights, AMixtureIsFoundAgain) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    WeightProblem problem = randomProblem(random, 12, 40);
    WeightProblem::Vector truth = WeightProblem::Vector::Zero(12);
    truth[trial % 12] = 0.6;
    truth[(trial + 5) % 12] = 0.3;
    truth[(trial + 7) % 12] = 0.1;
    problem.linear = problem.gram * truth;
    EXPECT_LT((sparseConvexWeights(problem, 4) - truth).norm(), 1e-6) << trial;
  }
}

TEST(ConvexWeights, BonesThatMoveAlikeAreNoTrouble) {
  WeightProblem problem;
  problem.gram = WeightProblem::Matrix::Ones(4, 4);
  problem.linear = WeightProblem::Vector::Ones(4);
  const WeightProblem::Vector weights = sparseConvexWeights(problem, 4);
  expectConvex(weights, 4);
  EXPECT_NEAR(problem.value(weights), -1, 1e-9);
  problem.gram.setZero();
  problem.linear.setZero();
  expectConvex(sparseConvexWeights(problem, 4), 4);
}

}  // namespace
}  // namespace limber
