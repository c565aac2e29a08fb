#include "limber/decomposition/convex_weights.h"

#include <algorithm>
#include <array>
#include <optional>

#include "limber/ik/small_solve.h"

namespace limber {

namespace {

using Vector = WeightProblem::Vector;

// Of the diagonal: directions in which bones move the vertex alike to rounding.
constexpr double kDamping = 1e-10;
// Of the size of the gradient: less is rounding.
constexpr double kGain = 1e-10;

struct Support {
  std::array<int, kMostCandidates> members = {};
  int count = 0;

  void add(int member) { members[count++] = member; }
  void remove(int at) {
    std::copy(members.begin() + at + 1, members.begin() + count, members.begin() + at);
    --count;
  }
};

// The least value over the support with sum 1 and without regard to signs; the others are 0.
Vector leastOver(const WeightProblem& problem, const Support& support) {
  Vector weights = Vector::Zero(problem.linear.size());
  const int base = support.members[0], size = support.count - 1;
  const auto& gram = problem.gram;
  WeightProblem::Matrix differences(size, size);
  Vector shares(size);
  for (int i = 0; i < size; ++i) {
    const int a = support.members[i + 1];
    for (int j = 0; j < size; ++j) {
      const int b = support.members[j + 1];
      differences(i, j) = gram(a, b) - gram(a, base) - gram(base, b) + gram(base, base);
    }
    shares[i] = problem.linear[a] - problem.linear[base] - gram(a, base) + gram(base, base);
  }
  if (size > 0) {
    solveCholesky(differences, kDamping * gram.diagonal().maxCoeff(), shares);
  }
  weights[base] = 1;
  for (int i = 0; i < size; ++i) {
    weights[support.members[i + 1]] = shares[i];
    weights[base] -= shares[i];
  }
  return weights;
}

// Goes from `weights`, which are 0 or more, towards the least value over the support; a member that comes to 0 on the
// way leaves it.
Vector feasibleLeast(const WeightProblem& problem, Support& support, Vector weights) {
  while (true) {
    const Vector wanted = leastOver(problem, support);
    double step = 1;
    std::optional<int> blocking;
    for (int i = 0; i < support.count; ++i) {
      const int m = support.members[i];
      if (wanted[m] > 0) continue;
      const double reach = weights[m] > 0 ? weights[m] / (weights[m] - wanted[m]) : 0;
      if (blocking && reach >= step) continue;
      step = reach;
      blocking = i;
    }
    if (!blocking) return wanted;
    weights += step * (wanted - weights);
    weights[support.members[*blocking]] = 0;
    support.remove(*blocking);
  }
}

// The bone out of the support that lowers the value most steeply; none where none does.
std::optional<int> steepest(const WeightProblem& problem, const Support& support, const Vector& weights,
                            const Support& allowed) {
  const Vector slope = problem.gram * weights - problem.linear;
  double level = 0;
  for (int i = 0; i < support.count; ++i) level += slope[support.members[i]] * weights[support.members[i]];
  double best = level - kGain * (problem.gram.diagonal().maxCoeff() + problem.linear.cwiseAbs().maxCoeff());
  std::optional<int> result;
  for (int i = 0; i < allowed.count; ++i) {
    const int m = allowed.members[i];
    if (weights[m] > 0 || !(slope[m] < best)) continue;
    best = slope[m];
    result = m;
  }
  return result;
}

struct Solution {
  Support support;
  Vector weights;
};

Solution solveAmong(const WeightProblem& problem, const Support& allowed) {
  Solution solution;
  int first = allowed.members[0];
  const auto alone = [&](int m) { return problem.gram(m, m) - 2 * problem.linear[m]; };
  for (int i = 1; i < allowed.count; ++i) {
    if (alone(allowed.members[i]) < alone(first)) first = allowed.members[i];
  }
  solution.support.add(first);
  solution.weights = Vector::Zero(problem.linear.size());
  solution.weights[first] = 1;
  double value = problem.value(solution.weights);
  for (Index round = 0; round < 4 * kMostCandidates; ++round) {
    const std::optional<int> entering = steepest(problem, solution.support, solution.weights, allowed);
    if (!entering) break;
    Solution next = solution;
    next.support.add(*entering);
    next.weights = feasibleLeast(problem, next.support, next.weights);
    const double better = problem.value(next.weights);
    if (!(better < value)) break;  // rounding
    solution = next;
    value = better;
  }
  return solution;
}

}  // namespace

double WeightProblem::value(const Vector& weights) const {
  return weights.dot(gram * weights) - 2 * linear.dot(weights);
}

WeightProblem::Vector sparseConvexWeights(const WeightProblem& problem, Index maxInfluences) {
  Support all;
  for (int m = 0; m < problem.linear.size(); ++m) all.add(m);
  Solution solution = solveAmong(problem, all);
  while (solution.support.count > static_cast<int>(maxInfluences)) {
    std::optional<Solution> best;
    double least = 0;
    for (int i = 0; i < solution.support.count; ++i) {
      Support fewer = solution.support;
      fewer.remove(i);
      const Solution tried = solveAmong(problem, fewer);
      const double value = problem.value(tried.weights);
      if (best && value >= least) continue;
      best = tried;
      least = value;
    }
    solution = *best;
  }
  return solution.weights;
}

}  // namespace limber
