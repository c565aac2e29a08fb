// Where a point lies to the convex hull of others in the plane.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include <Eigen/Core>

namespace limber {

// Outside by `distance`, or inside by minus that, nearest to the point between corners a and b (numbers of the points
// given), away from it in direction `out`.
struct HullPoint {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t a = 0, b = 0;
  double weight = 0;  // of b, 0 to 1; of a the rest
  Eigen::Vector2d out = Eigen::Vector2d::UnitX();
};

// Hulls without an area (one point, or all on a line) have no inside. At least one corner, all finite. The hull is
// Andrew's monotone chain (1979). Cost: O(n log n).
HullPoint nearestOnHull(const Eigen::Vector2d& point, std::span<const Eigen::Vector2d> corners);

// Where a segment from a to b comes nearest to a point: the weight of b, 0 to 1.
template <class Vector>
double nearestOnSegment(const Vector& point, const Vector& a, const Vector& b) {
  const Vector line = b - a;
  const double squared = line.squaredNorm();
  if (!(squared > 0)) return 0;
  const double weight = (point - a).dot(line) / squared;
  return weight < 0 ? 0 : weight > 1 ? 1 : weight;
}

}  // namespace limber
