#include "limber/skeleton/ik/support_polygon.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace limber {

namespace {

using Corners = std::span<const Eigen::Vector2d>;

constexpr double kFlat = 1e-9;  // of its length: the height of a corner over an edge that counts as none

// Does the path from a over b to c turn left?
bool turnsLeft(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d whole = c - a, part = b - a;
  return part.x() * whole.y() - part.y() * whole.x() > kFlat * whole.squaredNorm();
}

// The hull's corners, counter-clockwise; two where all lie on a line, one where all are at one position.
std::vector<std::size_t> hullOf(Corners corners) {
  std::vector<std::size_t> order(corners.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto isBefore = [&](std::size_t i, std::size_t j) {
    const Eigen::Vector2d &p = corners[i], &q = corners[j];
    return p.x() != q.x() ? p.x() < q.x() : p.y() != q.y() ? p.y() < q.y() : i < j;
  };
  std::sort(order.begin(), order.end(), isBefore);
  const auto isSame = [&](std::size_t i, std::size_t j) { return corners[i] == corners[j]; };
  order.erase(std::unique(order.begin(), order.end(), isSame), order.end());
  if (order.size() < 3) return order;
  std::vector<std::size_t> hull;
  for (const bool isUpper : {false, true}) {
    const std::size_t begin = hull.size();
    for (const std::size_t next : order) {
      while (hull.size() > begin + 1 &&
             !turnsLeft(corners[hull[hull.size() - 2]], corners[hull.back()], corners[next])) {
        hull.pop_back();
      }
      hull.push_back(next);
    }
    hull.pop_back();  // where the other half begins
    if (!isUpper) std::reverse(order.begin(), order.end());
  }
  return hull;
}

}  // namespace

HullPoint nearestOnHull(const Eigen::Vector2d& point, Corners corners) {
  const std::vector<std::size_t> hull = hullOf(corners);
  HullPoint outside, inside;
  inside.distance = -std::numeric_limits<double>::infinity();
  bool isInside = hull.size() > 2;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const std::size_t a = hull[i], b = hull[(i + 1) % hull.size()];
    const double weight = nearestOnSegment(point, corners[a], corners[b]);
    const Eigen::Vector2d away = point - (corners[a] + weight * (corners[b] - corners[a]));
    const double distance = away.norm();
    if (distance < outside.distance) {
      outside = {distance, a, b, weight, distance > 0 ? Eigen::Vector2d(away / distance) : outside.out};
    }
    if (hull.size() < 3) continue;
    const Eigen::Vector2d line = corners[b] - corners[a];
    const Eigen::Vector2d normal = Eigen::Vector2d(line.y(), -line.x()).normalized();
    const double height = normal.dot(point - corners[a]);
    if (height > 0) isInside = false;
    if (height > inside.distance) inside = {height, a, b, weight, normal};
  }
  return isInside ? inside : outside;
}

}  // namespace limber
