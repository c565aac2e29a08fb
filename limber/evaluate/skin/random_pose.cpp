#include "limber/evaluate/skin/random_pose.h"

namespace limber {

std::uint64_t SplitMix::next() {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

double SplitMix::uniform() {
  return static_cast<double>(next() >> 11) * 0x1.0p-53;
}

Vec3 SplitMix::unitVector() {
  while (true) {
    const double x = 2 * uniform() - 1, y = 2 * uniform() - 1, z = 2 * uniform() - 1;
    const Vec3 point(x, y, z);
    const double length = point.norm();
    if (length <= 1 && length > 1e-3) return point / length;
  }
}

Pose randomPose(const Skeleton& skeleton, double maxRadians, SplitMix& random) {
  Pose pose = restPose(skeleton);
  for (Transform& local : pose.locals) {
    const Vec3 axis = random.unitVector();
    const double angle = maxRadians * random.uniform();
    local.rotation = (local.rotation * Quat(Eigen::AngleAxisd(angle, axis))).normalized();
  }
  return pose;
}

}  // namespace limber
