#include "limber/skeleton/clip/root_extraction.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/clip/keys/movement_keys.h"
#include "limber/skeleton/clip/moving_roots.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr double kBetweenKeys = 2.5e-7;  // of the skeleton's size, and radians: how far linear tracks may be off

// One joint's local transform over time, as the clip has it.
class JointMovement {
 public:
  JointMovement(const Skeleton& skeleton, const Clip& clip, Index joint)
      : rest_(skeleton.joints[joint].rest),
        translation_(findTrack(clip.translations, joint)),
        rotation_(findTrack(clip.rotations, joint)),
        scale_(findTrack(clip.scales, joint)) {}

  Transform at(double seconds) const {
    Transform result = rest_;
    if (translation_) result.translation = sampleTrack(*translation_, seconds);
    if (rotation_) result.rotation = sampleTrack(*rotation_, seconds);
    if (scale_) result.scale = sampleTrack(*scale_, seconds);
    return result;
  }

  bool turnsOrGrows() const { return rotation_ || scale_; }

  void addKeys(std::vector<float>& times) const {
    if (translation_) addKeyTimes(*translation_, times);
    if (rotation_) addKeyTimes(*rotation_, times);
    if (scale_) addKeyTimes(*scale_, times);
  }

 private:
  Transform rest_;
  const Track<Vec3f>* translation_;
  const Track<Eigen::Quaternionf>* rotation_;
  const Track<Vec3f>* scale_;
};

// The joints that carry the body's trajectory: those that move, or the roots where the body does not move.
std::vector<MovingRoot> carriersOf(const Skeleton& skeleton, const Clip& clip, Index body) {
  std::vector<MovingRoot> carriers = movingRoots(skeleton, clip);
  const auto carriesBody = [&](const MovingRoot& root) { return isAncestorOrSelf(skeleton, root.joint, body); };
  if (std::any_of(carriers.begin(), carriers.end(), carriesBody)) return carriers;
  carriers.clear();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) carriers.push_back({j});
  }
  return carriers;
}

}  // namespace

Clip clipInPlace(const Skeleton& skeleton, const Clip& clip, Index body, const RootTrajectory& trajectory) {
  Clip result = clip;
  for (const MovingRoot& root : carriersOf(skeleton, clip, body)) {
    const Affine toAbove = root.above.inverse(Eigen::Affine);
    if (!toAbove.matrix().allFinite()) continue;  // below a scale of 0 nothing shows
    const JointMovement joint(skeleton, clip, root.joint);
    std::vector<float> times = trajectory.times;
    joint.addKeys(times);
    const MovingTransform movement = [&](double seconds) {
      return decompose(toAbove * trajectory.at(seconds).toAffine().inverse(Eigen::Isometry) * root.above *
                       joint.at(seconds).toAffine());
    };
    MovementKeys(movement, std::move(times), sizeSeenFrom(skeleton, skeleton.joints[root.joint].parent), kBetweenKeys)
        .writeTo(result, root.joint, !trajectory.headings.empty());
  }
  return result;
}

Clip extractRootMotion(const Skeleton& skeleton, const Clip& clip, Index root, const RootTrajectory& trajectory) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent.has_value() != (j == root)) continue;
    throw Error(ErrorCode::kBadArgument, "is not the only root of the skeleton",
                fmt::format("joint '{}'", skeleton.joints[root].name));
  }
  const Affine rest = skeleton.joints[root].rest.toAffine();
  const Affine toRest = rest.inverse(Eigen::Affine);
  if (!toRest.matrix().allFinite()) {
    throw Error(ErrorCode::kBadArgument, "has a rest transform without an inverse",
                fmt::format("joint '{}'", skeleton.joints[root].name));
  }
  Clip result = clip;
  const double size = sizeSeenFrom(skeleton, root);
  const JointMovement before(skeleton, clip, root);
  std::vector<float> rootTimes = trajectory.times;
  before.addKeys(rootTimes);
  const bool turns = !trajectory.headings.empty() || before.turnsOrGrows() ||
                     skeleton.joints[root].rest.rotation.coeffs() != Quat::Identity().coeffs();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent != root) continue;
    const JointMovement joint(skeleton, clip, j);
    std::vector<float> times = rootTimes;
    joint.addKeys(times);
    const MovingTransform movement = [&](double seconds) {
      return decompose(toRest * trajectory.at(seconds).toAffine().inverse(Eigen::Isometry) *
                       before.at(seconds).toAffine() * joint.at(seconds).toAffine());
    };
    MovementKeys(movement, std::move(times), size, kBetweenKeys).writeTo(result, j, turns);
  }
  const MovingTransform movement = [&](double seconds) { return decompose(trajectory.at(seconds).toAffine() * rest); };
  MovementKeys(movement, trajectory.times, sizeSeenFrom(skeleton, std::nullopt), kBetweenKeys)
      .writeTo(result, root, turns);
  return result;
}

}  // namespace limber
