#include "limber/motion/retarget/displacement_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "limber/motion/limbs/roughness.h"
#include "limber/motion/retarget/band_matrix.h"

namespace limber {

namespace {

// Passes of the active set; 10 to 100; it settles in a few, more change nothing; set by hand.
constexpr int kMaxPasses = 30;
constexpr std::size_t kWidth = kThirdDifference.size() - 1;  // frames back that a third difference reaches

bool isCutBetween(std::span<const CurveGoal> goals, std::size_t first, std::size_t last) {
  for (std::size_t f = first + 1; f <= last; ++f) {
    if (goals[f].cut) return true;
  }
  return false;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// The least of x' matrix x / 2 - right' x + weight / 2 times the squares of what x is below its bounds: Newton's steps,
// each cut where that rises again (it is convex and piecewise quadratic, so this ends).
std::vector<double> aboveBounds(const BandMatrix& matrix, const std::vector<double>& right,
                                std::span<const CurveGoal> goals, double weight) {
  const std::size_t n = right.size();
  std::vector<double> x(n, 0.0), step(n);
  for (std::size_t f = 0; f < n; ++f) x[f] = std::max(goals[f].least, 0.0);
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    BandMatrix factored = matrix;
    step = right;
    for (std::size_t f = 0; f < n; ++f) {
      if (x[f] >= goals[f].least) continue;
      factored.at(f, f) += weight;
      step[f] += weight * goals[f].least;
    }
    factored.solve(step);
    for (std::size_t f = 0; f < n; ++f) step[f] -= x[f];
    const std::vector<double> pushed = matrix.times(step);
    const double slope = dot(pushed, x) - dot(right, step), rise = dot(pushed, step);
    const auto slopeAt = [&](double t) {
      double sum = slope + t * rise;
      for (std::size_t f = 0; f < n; ++f) sum -= weight * step[f] * std::max(goals[f].least - x[f] - t * step[f], 0.0);
      return sum;
    };
    double t = 1;
    if (slopeAt(1) > 0) {
      double low = 0;
      for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + t);
        (slopeAt(middle) > 0 ? t : low) = middle;
      }
    }
    bool settled = t == 1;
    for (std::size_t f = 0; f < n; ++f) {
      const bool below = x[f] < goals[f].least;
      x[f] += t * step[f];
      settled = settled && below == (x[f] < goals[f].least);
    }
    if (settled) break;
  }
  return x;
}

}  // namespace

std::vector<double> displacementCurve(std::span<const CurveGoal> goals, double frameSeconds,
                                      const CurveOptions& options) {
  const std::size_t n = goals.size();
  BandMatrix fixed(n, kWidth);
  std::vector<double> right(n, 0.0);
  const double stiffness = smoothnessWeight(options.seconds, frameSeconds);
  for (std::size_t f = 0; f < n; ++f) {
    const CurveGoal& goal = goals[f];
    fixed.at(f, f) += options.pull + goal.valueWeight;
    right[f] += goal.valueWeight * goal.value;
    if (f >= 1 && !goal.cut) {
      fixed.at(f, f) += goal.stepWeight;
      fixed.at(f - 1, f - 1) += goal.stepWeight;
      fixed.at(f, f - 1) -= goal.stepWeight;
      right[f] += goal.stepWeight * goal.step;
      right[f - 1] -= goal.stepWeight * goal.step;
    }
    if (f < kWidth || isCutBetween(goals, f - kWidth, f)) continue;
    for (std::size_t i = 0; i <= kWidth; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        fixed.at(f - kWidth + i, f - kWidth + k) += stiffness * kThirdDifference[i] * kThirdDifference[k];
      }
    }
  }
  return aboveBounds(fixed, right, goals, options.minWeight);
}

}  // namespace limber
