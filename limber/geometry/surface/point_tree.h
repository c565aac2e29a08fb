// A box tree over points along a space-filling curve, and the curve's order itself.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Indices of the points along a Morton curve through their box (1024 cells a side), equal cells by index; what crowds
// in one cell is ordered along a curve of its own. Neighbours in space are mostly neighbours in the order. Cost:
// O(#points).
std::vector<Index> mortonOrder(std::span<const Vec3f> points);

// Finds pairs of near points that belong to different pieces, and the nearest point. Pieces may be renamed as they grow
// together. Takes the same time wherever the points lie: one far away from the others spoils no cell size.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3f> points);

  // order()[i] is the i-th point along the curve.
  const std::vector<Index>& order() const { return order_; }

  // pieces  per point; kept by reference until the next call
  void setPieces(std::span<const Index> pieces);

  // Part of the points: those of one box of the tree.
  using Part = std::size_t;
  // The piece of all points of the part, kNoIndex where there are several.
  Index pieceOf(Part part) const { return uniform_[part]; }
  // For each part the largest value of its points (0 for a part without any).
  std::vector<float> largestOf(std::span<const float> values) const;

  // Calls pair(a, b, squaredDistance) once for two points of different pieces that are no farther apart (squared) than
  // reach(part) of a part with either of them. `reach` may fall from call to call. Two subtrees are compared
  // at a time (March, Ram, Gray: Fast Euclidean Minimum Spanning Tree, 2010).
  template <typename Reach, typename Pair>
  void forNearPairs(const Reach& reach, const Pair& pair) const {
    visit(1, 1, 0, reach, pair);
  }

  // The nearest point that is no farther than `radius` from p, of equals the lowest; kNoIndex where there is none.
  Index nearest(const Vec3f& p, float radius) const;
  // From now on `nearest` passes over the point; pairs are not to be asked for any more. Cost: O(log #points).
  void takeOut(Index point);

 private:
  struct Box3 {
    Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
    Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());
  };
  static constexpr Index kLeafSize = 8;

  void boundLeaf(Part leaf);
  void boundInner(Part part);
  std::size_t beginOf(Part leaf) const { return std::min((leaf - leaves_) * kLeafSize, order_.size()); }
  float distanceSquared(Part part, const Vec3f& p) const {
    return (boxes_[part].min - p).cwiseMax(p - boxes_[part].max).cwiseMax(0.0f).squaredNorm();
  }
  float distanceSquared(Part a, Part b) const {
    const Box3 &first = boxes_[a], &second = boxes_[b];
    return (first.min - second.max).cwiseMax(second.min - first.max).cwiseMax(0.0f).squaredNorm();
  }
  template <typename Reach, typename Pair>
  void visit(Part a, Part b, float distance, const Reach& reach, const Pair& pair) const;
  template <typename Pair>
  void comparePoints(Part a, Part b, float bound, const Pair& pair) const;

  std::span<const Vec3f> points_;
  std::span<const Index> pieces_;
  std::vector<Index> order_;    // kNoIndex where a point was taken out
  std::vector<Index> slotOf_;   // in the order, of each point; made when the first is taken out
  std::size_t leaves_ = 1;      // a power of two; node i has children 2i and 2i + 1, leaf j is node leaves_ + j
  std::vector<Box3> boxes_;     // per node
  std::vector<Index> uniform_;  // per node: the piece of all its points, kNoIndex if mixed
};

// Both parts are as deep in the tree, and `distance` (squared) apart. The nearest children first, so that a falling
// reach falls early.
template <typename Reach, typename Pair>
void PointTree::visit(Part a, Part b, float distance, const Reach& reach, const Pair& pair) const {
  const float bound = std::max(reach(a), reach(b));
  if (distance > bound) return;
  if (a >= leaves_) {
    comparePoints(a, b, bound, pair);
    return;
  }
  struct Visit {
    float distance;
    Part a, b;
  };
  std::array<Visit, 4> visits;
  std::size_t count = 0;
  const auto add = [&](Part first, Part second) {
    if (uniform_[first] != kNoIndex && uniform_[first] == uniform_[second]) return;
    const Visit added{distanceSquared(first, second), first, second};
    std::size_t slot = count++;
    for (; slot > 0 && added.distance < visits[slot - 1].distance; --slot) visits[slot] = visits[slot - 1];
    visits[slot] = added;
  };
  add(2 * a, 2 * b);
  add(2 * a + 1, 2 * b + 1);
  add(2 * a, 2 * b + 1);
  if (a != b) add(2 * a + 1, 2 * b);
  for (std::size_t i = 0; i < count; ++i) visit(visits[i].a, visits[i].b, visits[i].distance, reach, pair);
}

template <typename Pair>
void PointTree::comparePoints(Part a, Part b, float bound, const Pair& pair) const {
  for (std::size_t i = beginOf(a); i < beginOf(a + 1); ++i) {
    for (std::size_t j = a == b ? i + 1 : beginOf(b); j < beginOf(b + 1); ++j) {
      const float distance = (points_[order_[i]] - points_[order_[j]]).squaredNorm();
      if (distance > bound || pieces_[order_[i]] == pieces_[order_[j]]) continue;
      pair(order_[i], order_[j], distance);
    }
  }
}

}  // namespace limber
