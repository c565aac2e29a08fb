#include "limber/skeleton/clip/moving_roots.h"

#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr float kConstant = 1e-6f;  // metres, radians and the like: what exporters round the same value to

template <typename Value>
bool moves(const Track<Value>& track) {
  const bool cubic = track.interpolation == Interpolation::kCubic;
  const auto& first = coefficientsOf(track.values[cubic ? 1 : 0]);
  for (std::size_t v = 0; v < track.values.size() && track.times.size() > 1; ++v) {
    const bool isTangent = cubic && v % 3 != 1;
    const auto& numbers = coefficientsOf(track.values[v]);
    if ((isTangent ? numbers.norm() : (numbers - first).norm()) > kConstant) return true;
  }
  return false;
}

}  // namespace

std::vector<MovingRoot> movingRoots(const Skeleton& skeleton, const Clip& clip) {
  std::vector<bool> carried(skeleton.jointCount(), false);
  forEachTrack(clip, [&](const auto& track) { carried[track.joint] = carried[track.joint] || moves(track); });
  Pose pose = restPose(skeleton);
  sampleClip(clip, 0, pose);
  const std::vector<Affine> globals = poseGlobals(skeleton, pose);
  std::vector<MovingRoot> roots;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = skeleton.joints[j].parent;
    if (parent && carried[*parent]) {
      carried[j] = true;
    } else if (carried[j]) {
      roots.push_back({j, parent ? globals[*parent] : Affine::Identity()});
    }
  }
  return roots;
}

}  // namespace limber
