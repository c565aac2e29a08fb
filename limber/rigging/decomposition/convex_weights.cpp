#include "limber/rigging/decomposition/convex_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "limber/core/small_solve.h"

namespace limber {

namespace {

using Vector = WeightProblem::Vector;

// Of the diagonal: directions in which bones move the vertex alike to rounding.
constexpr double kDamping = 1e-10;
// Of the size of the gradient: less is rounding.
constexpr double kGain = 1e-10;

struct Support {
  std::array<int, kMaxCandidates> members = {};
  int count = 0;

  void add(int member) { members[count++] = member; }
  void remove(int at) {
    std::copy(members.begin() + at + 1, members.begin() + count, members.begin() + at);
    --count;
  }
};

// The least value over the support with sum 1 and without regard to signs; the others are 0.
Vector minOver(const WeightProblem& problem, const Support& support) {
  Vector weights = Vector::Zero(problem.linear.size());
  const int base = support.members[0], size = support.count - 1;
  const auto& gram = problem.gram;
  WeightProblem::Matrix differences(size, size);
  Vector fractions(size);
  for (int i = 0; i < size; ++i) {
    const int a = support.members[i + 1];
    for (int j = 0; j < size; ++j) {
      const int b = support.members[j + 1];
      differences(i, j) = gram(a, b) - gram(a, base) - gram(base, b) + gram(base, base);
    }
    fractions[i] = problem.linear[a] - problem.linear[base] - gram(a, base) + gram(base, base);
  }
  if (size > 0) {
    solveCholesky(differences, kDamping * gram.diagonal().maxCoeff(), fractions);
  }
  weights[base] = 1;
  for (int i = 0; i < size; ++i) {
    weights[support.members[i + 1]] = fractions[i];
    weights[base] -= fractions[i];
  }
  return weights;
}

// Goes from `weights`, which are 0 or more, towards the least value over the support; a member whose weight comes to 0
// before that leaves the support.
Vector feasibleMin(const WeightProblem& problem, Support& support, Vector weights) {
  while (true) {
    const Vector wanted = minOver(problem, support);
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

struct Solution {
  Support support;
  Vector weights;

  double value(const WeightProblem& problem) const {
    double sum = 0;
    for (int i = 0; i < support.count; ++i) {
      const int m = support.members[i];
      sum += weights[m] * (halfSlope(problem, m) - problem.linear[m]);
    }
    return sum;
  }

  // How steeply the value rises with one of the weights, halved.
  double halfSlope(const WeightProblem& problem, int m) const {
    double sum = -problem.linear[m];
    for (int i = 0; i < support.count; ++i) {
      sum += problem.gram(support.members[i], m) * weights[support.members[i]];
    }
    return sum;
  }
};

// The bone out of the support that lowers the value most steeply; none where none does.
std::optional<int> steepest(const WeightProblem& problem, const Solution& solution, const Support& allowed) {
  double level = 0, size = 0;
  for (int i = 0; i < solution.support.count; ++i) {
    const int m = solution.support.members[i];
    level += solution.halfSlope(problem, m) * solution.weights[m];
    size = std::max({size, problem.gram(m, m), std::abs(problem.linear[m])});
  }
  double best = level - kGain * size;
  std::optional<int> result;
  for (int i = 0; i < allowed.count; ++i) {
    const int m = allowed.members[i];
    if (solution.weights[m] > 0) continue;
    const double slope = solution.halfSlope(problem, m);
    if (!(slope < best)) continue;
    best = slope;
    result = m;
  }
  return result;
}

// The best bone alone.
Solution bestAlone(const WeightProblem& problem, const Support& allowed) {
  int first = allowed.members[0];
  const auto alone = [&](int m) { return problem.gram(m, m) - 2 * problem.linear[m]; };
  for (int i = 1; i < allowed.count; ++i) {
    if (alone(allowed.members[i]) < alone(first)) first = allowed.members[i];
  }
  Solution solution;
  solution.support.add(first);
  solution.weights = Vector::Zero(problem.linear.size());
  solution.weights[first] = 1;
  return solution;
}

// From weights that are 0 or more and sum to 1 to the best among the bones allowed.
Solution solveAmong(const WeightProblem& problem, const Support& allowed, Solution solution) {
  solution.weights = feasibleMin(problem, solution.support, solution.weights);
  double value = solution.value(problem);
  for (Index round = 0; round < 4 * kMaxCandidates; ++round) {
    const std::optional<int> entering = steepest(problem, solution, allowed);
    if (!entering) break;
    Solution next = solution;
    next.support.add(*entering);
    next.weights = feasibleMin(problem, next.support, next.weights);
    const double better = next.value(problem);
    if (!(better < value)) break;  // rounding
    solution = next;
    value = better;
  }
  return solution;
}

// Without the member of the support at `at`: the other weights grow together.
Solution withoutMember(const WeightProblem& problem, const Solution& solution, int at) {
  Solution fewer = solution;
  const double left = 1 - fewer.weights[fewer.support.members[at]];
  fewer.weights[fewer.support.members[at]] = 0;
  fewer.support.remove(at);
  if (left > 0) {
    fewer.weights /= left;
  } else {
    fewer = bestAlone(problem, fewer.support);
  }
  return solveAmong(problem, fewer.support, fewer);
}

}  // namespace

double WeightProblem::value(const Vector& weights) const {
  return weights.dot(gram * weights) - 2 * linear.dot(weights);
}

WeightProblem::Vector sparseConvexWeights(const WeightProblem& problem, Index maxInfluences, const Vector& start) {
  Support all;
  for (int m = 0; m < problem.linear.size(); ++m) all.add(m);
  Solution solution = bestAlone(problem, all);
  if (start.size() == problem.linear.size() && start.sum() > 0) {
    solution.support = {};
    solution.weights = start / start.sum();
    for (int m = 0; m < start.size(); ++m) {
      if (start[m] > 0) solution.support.add(m);
    }
  }
  solution = solveAmong(problem, all, solution);
  while (solution.support.count > static_cast<int>(maxInfluences)) {
    std::optional<Solution> best;
    double least = 0;
    for (int i = 0; i < solution.support.count; ++i) {
      const Solution tried = withoutMember(problem, solution, i);
      const double value = tried.value(problem);
      if (best && value >= least) continue;
      best = tried;
      least = value;
    }
    solution = *best;
  }
  return solution.weights;
}

}  // namespace limber
