// The best weights of one vertex: few, none below zero, summing to one.
#pragma once

#include "limber/core/types.h"

namespace limber {

// Bones that are weighed against each other for one vertex; see sparseConvexWeights.
inline constexpr Index kMaxCandidates = 16;

// A function of weights w: w' gram w - 2 linear' w, where gram (symmetric, positive semi-definite) and linear are sums
// over frames of products of where the bones take the vertex and where it is.
struct WeightProblem {
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxCandidates, kMaxCandidates>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxCandidates, 1>;
  Matrix gram;    // #m x #m, #m from 1 to kMaxCandidates
  Vector linear;  // #m

  double value(const Vector& weights) const;
};

// The least value among weights that are 0 or more and sum to 1: the active set method of Lawson and Hanson (Solving
// Least Squares Problems, 1974, chapter 23), with the sum fixed by differences to one of the weights. Where more than
// `maxInfluences` (1 or more) are left above 0, the one without which the value grows least goes, one after the other,
// and the rest is solved again: the result is the best of its own support, and the best of all where nothing had to go.
// Deterministic; allocates nothing.
//
// start  initial weights, 0 or more; where little has changed, few steps lead from them. Empty: the best bone
WeightProblem::Vector sparseConvexWeights(const WeightProblem& problem, Index maxInfluences,
                                          const WeightProblem::Vector& start = {});

}  // namespace limber
