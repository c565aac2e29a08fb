// Bars with a closed form, and small lattices against projected Gauss-Seidel on the dense matrix.
#include "limber/rigging/weights/lattice/lattice_biharmonic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include "limber/core/random.h"

namespace limber {
namespace {

LatticeGraph boxGraph(int nx, int ny, int nz) {
  LatticeGraph graph;
  const auto at = [&](int x, int y, int z) {
    const bool inside = x >= 0 && y >= 0 && z >= 0 && x < nx && y < ny && z < nz;
    return inside ? static_cast<Index>((z * ny + y) * nx + x) : kNoIndex;
  };
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        graph.neighbors.push_back(
            {at(x - 1, y, z), at(x + 1, y, z), at(x, y - 1, z), at(x, y + 1, z), at(x, y, z - 1), at(x, y, z + 1)});
      }
    }
  }
  return graph;
}

Eigen::MatrixXd denseEnergy(const LatticeGraph& graph) {
  Eigen::MatrixXd laplacian = Eigen::MatrixXd::Zero(graph.nodeCount(), graph.nodeCount());
  for (Index i = 0; i < graph.nodeCount(); ++i) {
    for (const Index next : graph.neighbors[i]) {
      if (next == kNoIndex) continue;
      laplacian(i, i) += 1;
      laplacian(i, next) -= 1;
    }
  }
  return laplacian.transpose() * laplacian;
}

// One node after the other to its best value within bounds, until nothing moves.
std::vector<double> projectedGaussSeidel(const LatticeGraph& graph, const std::vector<bool>& pinned,
                                         std::vector<double> w) {
  const Eigen::MatrixXd energy = denseEnergy(graph);
  for (int sweep = 0; sweep < 100000; ++sweep) {
    double most = 0;
    for (Index i = 0; i < graph.nodeCount(); ++i) {
      if (pinned[i]) continue;
      double sum = 0;
      for (Index k = 0; k < graph.nodeCount(); ++k) sum += energy(i, k) * w[k];
      const double best = std::clamp(w[i] - sum / energy(i, i), 0.0, 1.0);
      most = std::max(most, std::abs(best - w[i]));
      w[i] = best;
    }
    if (most < 1e-12) break;
  }
  return w;
}

constexpr BiharmonicOptions kTight = {1e-9, 200000};

TEST(LatticeBiharmonic, ABarBetweenTwoBonesIsTheCubicThroughThem) {
  const int n = 20;
  const LatticeGraph bar = boxGraph(n, 1, 1);
  std::vector<bool> pinned(n, false);
  pinned[0] = pinned[1] = pinned[n - 2] = pinned[n - 1] = true;
  std::vector<double> w(n, 0.5);
  w[0] = w[1] = 0;
  w[n - 2] = w[n - 1] = 1;
  minimizeBoundedBiharmonic(bar, pinned, w, kTight);
  // Fourth differences are 0 between; the cubic through two values at either end.
  const double at[4] = {0, 1, n - 2, n - 1}, value[4] = {0, 0, 1, 1};
  for (int x = 0; x < n; ++x) {
    double expected = 0;
    for (int i = 0; i < 4; ++i) {
      double term = value[i];
      for (int k = 0; k < 4; ++k) term *= k == i ? 1 : (x - at[k]) / (at[i] - at[k]);
      expected += term;
    }
    EXPECT_NEAR(w[x], expected, 1e-5) << x;
  }
}

TEST(LatticeBiharmonic, StaysWithinBoundsBeyondABone) {
  // Pinned at 1 and 0 side by side: without bounds the line through them would go on.
  const LatticeGraph bar = boxGraph(16, 1, 1);
  std::vector<bool> pinned(16, false);
  pinned[7] = pinned[8] = true;
  std::vector<double> w(16, 0.5);
  w[7] = 1;
  w[8] = 0;
  minimizeBoundedBiharmonic(bar, pinned, w, kTight);
  for (int x = 0; x < 16; ++x) EXPECT_NEAR(w[x], x <= 7 ? 1 : 0, 1e-6) << x;
}

TEST(LatticeBiharmonic, IsTheDenseMinimumFromAnywhere) {
  for (const auto& size : {std::array{3, 3, 6}, std::array{4, 4, 4}, std::array{2, 1, 20}, std::array{6, 6, 1}}) {
    const LatticeGraph graph = boxGraph(size[0], size[1], size[2]);
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      limber::Random random(seed);
      std::vector<bool> pinned(graph.nodeCount(), false);
      std::vector<double> first(graph.nodeCount()), second(graph.nodeCount());
      for (Index i = 0; i < graph.nodeCount(); ++i) {
        pinned[i] = i == 0 || random.uniform() < 0.08;
        first[i] = pinned[i] ? std::round(random.uniform()) : random.uniform();
        second[i] = pinned[i] ? first[i] : 0;
      }
      const std::vector<double> expected = projectedGaussSeidel(graph, pinned, first);
      minimizeBoundedBiharmonic(graph, pinned, first, kTight);
      minimizeBoundedBiharmonic(graph, pinned, second, kTight);
      for (Index i = 0; i < graph.nodeCount(); ++i) {
        EXPECT_NEAR(first[i], expected[i], 2e-4) << size[2] << " " << seed << " " << i;
        EXPECT_NEAR(second[i], expected[i], 2e-4) << size[2] << " " << seed << " " << i;
      }
    }
  }
}

TEST(LatticeBiharmonic, EndsNearTheMinimumWithItsOwnTolerance) {
  const LatticeGraph graph = boxGraph(9, 9, 24);
  std::vector<bool> pinned(graph.nodeCount(), false);
  std::vector<double> w(graph.nodeCount(), 0);
  for (int z = 2; z < 22; ++z) {
    pinned[(z * 9 + 4) * 9 + 4] = true;
    w[(z * 9 + 4) * 9 + 4] = z >= 8 && z < 15;
  }
  std::vector<double> tight = w;
  const Index steps = minimizeBoundedBiharmonic(graph, pinned, w);
  minimizeBoundedBiharmonic(graph, pinned, tight, kTight);
  RecordProperty("steps", static_cast<int>(steps));
  for (Index i = 0; i < graph.nodeCount(); ++i) EXPECT_NEAR(w[i], tight[i], 4e-3) << i;
}

// A sheet whose edge belongs half to one joint and half to others, from nothing.
Index stepsOfSheet(int width, std::vector<double>& w, const BiharmonicOptions& options) {
  const LatticeGraph graph = boxGraph(width, width, 2);
  std::vector<bool> pinned(graph.nodeCount(), false);
  w.assign(graph.nodeCount(), 0);
  for (int i = 0; i < width; ++i) {
    pinned[i * width] = i > width / 2;
    pinned[i] = i < width / 4;
    if (pinned[i]) w[i] = 1;
  }
  return minimizeBoundedBiharmonic(graph, pinned, w, options);
}

// Conjugate gradients alone need steps by the square of the width.
TEST(LatticeBiharmonic, StepsGrowNoFasterThanASheetsWidth) {
  std::vector<double> w;
  const Index narrow = stepsOfSheet(12, w, {});
  const Index wide = stepsOfSheet(48, w, {});
  EXPECT_LT(wide, 4 * narrow);
  RecordProperty("narrow", static_cast<int>(narrow));
  RecordProperty("wide", static_cast<int>(wide));
  std::vector<double> tight;
  stepsOfSheet(48, tight, kTight);
  for (std::size_t i = 0; i < w.size(); ++i) ASSERT_NEAR(w[i], tight[i], 1e-3) << i;
}

TEST(LatticeBiharmonic, LeavesWhatNothingHoldsAsItIs) {
  const LatticeGraph graph = boxGraph(3, 3, 3);
  std::vector<double> w(27, 0);
  EXPECT_EQ(minimizeBoundedBiharmonic(graph, std::vector<bool>(27, false), w), 0u);
  EXPECT_EQ(w, std::vector<double>(27, 0));
}

}  // namespace
}  // namespace limber
