#include "limber/rigging/roles/likeliest_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr double kAsymmetryScale = 0.1;   // asymmetry that counts as much as e times less probability of a stance
constexpr double kMinProbability = 1e-3;  // of a stance
constexpr double kUnusualUp = 0.1;        // models whose up is neither +Y nor +Z, to those whose up is one of these
constexpr std::size_t kMaxFrames = 4;     // that are read
constexpr double kDoubt = 4;              // logarithm of likelihoods' ratio up to which a frame is read
constexpr double kIndependentJoints = 8;  // joints err together: all count as much as so many that err on their own

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

RoleReading readInLikeliestFrame(const std::vector<AnatomicalFrame>& frames, const LearnedStance& stance,
                                 const SurfaceSamples& surface, const ReadingWeights& weights) {
  struct Candidate {
    const AnatomicalFrame* frame;
    double likelihood;  // logarithm
  };
  std::vector<Candidate> candidates;
  for (const AnatomicalFrame& frame : frames) {
    const double probability = priorOf(frame) * std::max(probabilityOf(frame.axes, stance), kMinProbability);
    candidates.push_back({&frame, std::log(probability) - frame.asymmetry / kAsymmetryScale});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.likelihood > b.likelihood; });
  RoleReading best(surface, weights, *candidates.front().frame);
  double bestLikelihood = candidates.front().likelihood - kIndependentJoints * best.meanLogError();
  for (std::size_t k = 1; k < std::min(candidates.size(), kMaxFrames); ++k) {
    if (candidates[k].likelihood < candidates.front().likelihood - kDoubt) break;
    RoleReading reading(surface, weights, *candidates[k].frame);
    const double likelihood = candidates[k].likelihood - kIndependentJoints * reading.meanLogError();
    if (likelihood <= bestLikelihood) continue;
    bestLikelihood = likelihood;
    best = std::move(reading);
  }
  return best;
}

}  // namespace limber
