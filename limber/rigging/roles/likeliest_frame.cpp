#include "limber/rigging/roles/likeliest_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr double kAsymmetryScale = 0.1;   // asymmetry that counts as much as e times less probability of a stance
constexpr double kMinProbability = 1e-3;  // of a stance
constexpr double kUnusualUp = 0.1;        // models whose up is neither +Y nor +Z, to those whose up is one of these

// Of those with an axis that is up and one that is front. Rows: left, up, front.
double probabilityOf(const Mat3& axes, const LearnedStance& stance) {
  const std::array<Mat3, kStances> rotations = stanceRotations();
  std::size_t nearest = 0;
  const auto likeness = [&](std::size_t i) { return rotations[i].cwiseProduct(axes).sum(); };
  for (std::size_t i = 1; i < rotations.size(); ++i) {
    if (likeness(i) > likeness(nearest)) nearest = i;
  }
  return stance.probabilities[nearest];
}

// Files have +Y or +Z up, whatever the shape says; the networks learned all 24 stances alike.
double priorOf(const AnatomicalFrame& frame) {
  return std::max(frame.axes(1, 1), frame.axes(1, 2)) > std::cos(kPi / 4) - 1e-6 ? 1 : kUnusualUp;
}

}  // namespace

AnatomicalFrame likeliestFrame(const std::vector<AnatomicalFrame>& frames, const LearnedStance& stance) {
  const auto likelihood = [&](const AnatomicalFrame& frame) {
    const double probability = priorOf(frame) * std::max(probabilityOf(frame.axes, stance), kMinProbability);
    return std::log(probability) - frame.asymmetry / kAsymmetryScale;
  };
  return *std::max_element(frames.begin(), frames.end(), [&](const AnatomicalFrame& a, const AnatomicalFrame& b) {
    return likelihood(a) < likelihood(b);
  });
}

}  // namespace limber
