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
  std::vector<Vec3> positions;
  for (std::size_t j = 0; j < all.size(); ++j) {
    if (counts[j]) positions.push_back(all[j]);
  }
  if (positions.empty()) return std::nullopt;
  double sum = 0;
  for (const Vec3& position : positions) {
    const Vec3& normal = mirror->plane.normal;
    const Vec3 image = position - 2 * (normal.dot(position) - mirror->plane.offset) * normal;
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& other : positions) least = std::min(least, (other - image).squaredNorm());
    sum += std::sqrt(least);
  }
  return 100 * sum / static_cast<double>(positions.size()) / longestSide(model.mesh);
}

}  // namespace limber
