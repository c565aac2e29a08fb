// The conditional random field over a folded skeleton: scores of states, the best labelling, and how sure it is.
// Internal to the module; the tool that fits the weights uses it, too.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limber/character/anatomy/part_features.h"
#include "limber/character/anatomy/part_states.h"

namespace limber {

inline constexpr std::size_t kPaddedStates = 24;  // kPartStates and what fills up vectors of four

// Log-likelihoods: natural logarithms, learned.
struct PartWeights {
  std::vector<float> feature;  // partFeatureCount() x kPartStates
  std::vector<float> follow;  // kPartStates x kPartStates: of a parent's state and a child's; kNever where none follows
  std::vector<float> axes;    // axesFeatureCount()

  // What is read off `feature`, each row filled up with zeros to a whole number of vectors, and off `follow`: which
  // states may follow each, and the weights' exponentials.
  std::vector<float> padded;  // partFeatureCount() x kPaddedStates
  std::array<std::vector<std::uint8_t>, kPartStates> followers;
  std::array<double, kPartStates * kPartStates> followFactor{};
  void prepare();  // after each change
};
inline constexpr float kNever = -1e9f;  // log-likelihood, far below any sum of weights

// The fitted weights (part_weights.cpp), unpacked once.
const PartWeights& fittedPartWeights();

// What features say of each half joint's states: log-likelihoods.
using StateScores = std::vector<std::array<float, kPaddedStates>>;
void addScores(const BodyMeasures::Table& table, const PartWeights& weights, StateScores& scores);

// One reading of a skeleton: under one guess of the axes.
class PartField {
 public:
  using Scores = std::array<double, kPartStates>;

  // `own`: #half joints, of all features; `allowed`: likewise bit masks of states that each may have. Body and weights
  // must outlive this.
  PartField(const HalfBody& body, const StateScores& own, const PartWeights& weights,
            std::span<const std::uint32_t> allowed);

  // The state of each half joint in the likeliest labelling.
  std::vector<PartState> best() const;
  // Logarithm of the sum over all labellings of their scores' exponentials.
  double logSum() const { return logSum_; }
  double scoreOf(std::span<const PartState> states) const;
  // Probability of each state of each half joint; needs logSum() finite.
  std::vector<Scores> marginals() const;
  // Likewise of each pair of parent's and child's state, added up over all half joints with a parent.
  std::vector<double> followMarginals() const;

 private:
  void sumUp();
  std::vector<Scores> outside() const;

  const HalfBody& body_;
  const PartWeights& weights_;
  std::vector<Scores> own_;       // #half joints
  std::vector<Scores> below_;     // own and all that hangs there, summed
  std::vector<Scores> toParent_;  // what a half joint tells its parent, by the parent's state
  double logSum_ = 0;
};

}  // namespace limber
