#include "limber/evaluate/rig/rig_symmetry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/geometry/surface/mirror_map.h"
#include "limber/skeleton/pose.h"

namespace limber {

std::optional<double> jointAsymmetry(const SkinnedModel& model, const std::vector<bool>& counts) {
  const std::optional<MirrorMap> mirror = findMirror(model.mesh);
  if (!mirror) return std::nullopt;
  const std::vector<Vec3> all = restPositions(model.skeleton);
  std::vector<Vec3> places;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (counts[j]) places.push_back(all[j]);
  }
  if (places.empty()) return std::nullopt;
  double sum = 0;
  for (const Vec3& place : places) {
    const Vec3& normal = mirror->plane.normal;
    const Vec3 image = place - 2 * (normal.dot(place) - mirror->plane.offset) * normal;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& other : places) least = std::min(least, (other - image).squaredNorm());
    sum += std::sqrt(least);
  }
  return 100 * sum / static_cast<double>(places.size()) / longestSide(model.mesh);
}

}  // namespace limber
