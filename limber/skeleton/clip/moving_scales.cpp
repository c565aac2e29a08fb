#include "limber/skeleton/clip/moving_scales.h"

namespace limber {

std::vector<Index> jointsWithScales(const Skeleton& skeleton, const Clip& clip) {
  constexpr double kStillScale = 1e-3;  // relative
  std::vector<Index> joints;
  for (const Track<Vec3f>& track : clip.scales) {
    const Vec3& rest = skeleton.joints[track.joint].rest.scale;
    const std::size_t perKey = track.interpolation == Interpolation::kCubic ? 3 : 1;
    for (std::size_t v = perKey / 2; v < track.values.size(); v += perKey) {
      if ((track.values[v].cast<double>() - rest).norm() <= kStillScale * rest.norm()) continue;
      joints.push_back(track.joint);
      break;
    }
  }
  return joints;
}

}  // namespace limber
