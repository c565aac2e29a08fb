#include "limber/rigging/body/medial_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/shortest_paths.h"

namespace limber {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

std::size_t nearestSphere(const std::vector<MedialSphere>& spheres, const Vec3& position) {
  const auto apart = [&](const MedialSphere& sphere) { return (sphere.center - position).norm() - sphere.radius; };
  const auto nearest =
      std::min_element(spheres.begin(), spheres.end(),
                       [&](const MedialSphere& a, const MedialSphere& b) { return apart(a) < apart(b); });
  return static_cast<std::size_t>(nearest - spheres.begin());
}

// Spheres that all but touch, with the inside between them.
bool joined(const BodyVolume& body, const MedialSphere& a, const MedialSphere& b) {
  const double reach = a.radius + b.radius + 3 * body.distance->spacing();
  return (a.center - b.center).squaredNorm() < reach * reach && body.distance->at(0.5 * (a.center + b.center)) < 0;
}

}  // namespace

std::vector<Vec3> medialPath(const BodyVolume& body, const Vec3& from, const Vec3& to) {
  const std::vector<MedialSphere>& spheres = body.spheres;
  if (spheres.empty()) return {};
  // Dijkstra from the end, so that the path comes out in order.
  const std::size_t first = nearestSphere(spheres, from), last = nearestSphere(spheres, to);
  std::vector<double> length(spheres.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> next(spheres.size(), kNone);
  length[last] = 0;
  const auto forEachNeighbour = [&](std::size_t at, const auto& visit) {
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const double step = (spheres[s].center - spheres[at].center).norm();
      if (length[at] + step < length[s] && joined(body, spheres[s], spheres[at])) visit(s, step);
    }
  };
  shortenPaths(std::span(&last, 1), length, forEachNeighbour, [&](std::size_t at, std::size_t s) { next[s] = at; });
  if (!std::isfinite(length[first])) return {};
  std::vector<Vec3> path;
  for (std::size_t at = first; at != kNone; at = next[at]) path.push_back(spheres[at].center);
  return path;
}

Vec3 alongPath(const std::vector<Vec3>& path, double fraction) {
  double whole = 0;
  for (std::size_t i = 1; i < path.size(); ++i) whole += (path[i] - path[i - 1]).norm();
  double left = fraction * whole;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double step = (path[i] - path[i - 1]).norm();
    if (left <= step && step > 0) return path[i - 1] + left / step * (path[i] - path[i - 1]);
    left -= step;
  }
  return path.back();
}

}  // namespace limber
