// A box tree over points along a space-filling curve, and the curve's order itself.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Indices of the points along a Morton curve through their box (1024 cells a side), equal cells by index. Neighbours in
// space are mostly neighbours in the order. Cost: O(#points).
std::vector<Index> mortonOrder(std::span<const Vec3f> points);

// Finds nearest points that belong to another piece. Pieces may be renamed as they grow together.
class PointTree {
 public:
  explicit PointTree(std::span<const Vec3f> points);

  // order()[i] is the i-th point along the curve.
  const std::vector<Index>& order() const { return order_; }

  // pieces  per point; kept by reference until the next call
  void setPieces(std::span<const Index> pieces);

  struct Nearest {
    Index point = kNoIndex;  // kNoIndex: none within the radius
    float distanceSquared = 0;
  };
  // The point nearest to `point` that is of another piece and at most that far; ties by index.
  Nearest nearestOfOtherPiece(Index point, float mostDistanceSquared) const;

 private:
  struct Box3 {
    Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
    Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());
  };
  static constexpr Index kLeafSize = 8;

  std::span<const Vec3f> points_;
  std::span<const Index> pieces_;
  std::vector<Index> order_;
  std::size_t leaves_ = 1;      // a power of two; node i has children 2i and 2i + 1, leaf j is node leaves_ + j
  std::vector<Box3> boxes_;     // per node
  std::vector<Index> uniform_;  // per node: the piece of all its points, kNoIndex if mixed
};

}  // namespace limber
