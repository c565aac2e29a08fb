// The smoothest function within bounds on the nodes of a lattice.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// A graph whose nodes have at most six neighbors each, as the nodes of a regular grid. Both ends name each other.
struct LatticeGraph {
  static constexpr int kDirections = 6;

  std::vector<std::array<Index, kDirections>> neighbors;  // #N; kNoIndex where there is none

  Index nodeCount() const { return static_cast<Index>(neighbors.size()); }
};

struct BiharmonicOptions {
  double tolerance = 1e-4;      // ends when no value changes by more than this in a round of 64 steps
  Index maxIterations = 10000;  // steps in all
};

// Minimises the sum of (L w)^2 over all nodes, where (L w)(i) is the sum of w(i) - w(k) over the neighbors k of i, and
// 0 <= w <= 1: the Laplacian energy of Jacobson, Baran, Popović, Sorkine 2011 (equation 3) with the graph's Laplacian,
// whose own boundary condition is that values do not change across the border.
//
//   pinned  #N: nodes that keep their value
//   w       #N in [0, 1]: initial values, and the result. Parts of the graph without a pinned node should begin
//           constant, and then stay so.
//
// MPRGP (Dostál, Schöberl 2005): conjugate gradients on the nodes between the bounds, and steps along the projected
// gradient that let nodes go or bring them to their bounds; it descends to the one minimum from anywhere. Values are
// scaled by the diagonal. After 256 steps each round begins with Newton's step of all free nodes, projected onto the
// bounds (Bertsekas 1982), which a Cholesky factor gives: then steps grow by a sheet's width at most, not by its
// square. What a round leaves is kept only if it has less energy. It works within a few steps of where values are
// neither 0 nor 1, and widens that as needed. Returns the steps taken. Cost: O(nodes between the bounds) a step, and a
// factor of these for each round that begins with one.
Index minimizeBoundedBiharmonic(const LatticeGraph& graph, const std::vector<bool>& pinned, std::span<double> w,
                                const BiharmonicOptions& options = {});

}  // namespace limber
