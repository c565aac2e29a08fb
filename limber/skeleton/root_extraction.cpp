#include "limber/skeleton/root_extraction.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/chain.h"
#include "limber/skeleton/moving_roots.h"

namespace limber {

namespace {

constexpr double kBetweenKeys = 2.5e-7;  // of the skeleton's size, and radians: how far linear tracks may be off
constexpr float kSameScale = 5e-7f;      // relative: the same but for rounding
constexpr double kAside = 0.2113;  // of the time between two keys: where a cubic is farthest from its middle's line
constexpr int kMostHalvings = 8;   // of the time between two keys

template <typename Value>
const Track<Value>* trackOfJoint(const std::vector<Track<Value>>& tracks, Index joint) {
  const auto found =
      std::find_if(tracks.begin(), tracks.end(), [&](const auto& track) { return track.joint == joint; });
  return found == tracks.end() ? nullptr : &*found;
}

// One joint's local transform over time, as the clip has it.
class JointMovement {
 public:
  JointMovement(const Skeleton& skeleton, const Clip& clip, Index joint)
      : rest_(skeleton.joints[joint].rest),
        translation_(trackOfJoint(clip.translations, joint)),
        rotation_(trackOfJoint(clip.rotations, joint)),
        scale_(trackOfJoint(clip.scales, joint)) {}

  Transform at(double seconds) const {
    Transform result = rest_;
    if (translation_) result.translation = sampleTrack(*translation_, seconds);
    if (rotation_) result.rotation = sampleTrack(*rotation_, seconds);
    if (scale_) result.scale = sampleTrack(*scale_, seconds);
    return result;
  }

  bool turnsOrGrows() const { return rotation_ || scale_; }

  void addKeys(std::vector<float>& times) const {
    const auto add = [&](const auto* track) {
      if (!track) return;
      for (const float time : track->times) {
        // A step is a line as long as time itself has steps.
        if (track->interpolation == Interpolation::kStep && time > 0) times.push_back(std::nextafter(time, 0.0f));
        times.push_back(time);
      }
    };
    add(translation_);
    add(rotation_);
    add(scale_);
  }

 private:
  Transform rest_;
  const Track<Vec3f>* translation_;
  const Track<Eigen::Quaternionf>* rotation_;
  const Track<Vec3f>* scale_;
};

using Movement = std::function<Transform(double seconds)>;

// Linear keys of a movement, as many as it takes.
class MovementKeys {
 public:
  MovementKeys(const Movement& movement, const std::vector<float>& times, double size)
      : movement_(movement), size_(size) {
    for (const float time : times) {
      const Key next = keyAt(time);
      if (!keys_.empty()) divide(Key(keys_.back()), next, 0);
      keys_.push_back(next);
    }
  }

  // In place of what the clip has of that joint; rotations and scales only where they are `changed`.
  void writeTo(Clip& clip, Index joint, bool changed) const {
    const auto replace = [&](auto& tracks, auto&& value) {
      std::erase_if(tracks, [&](const auto& track) { return track.joint == joint; });
      auto& track = tracks.emplace_back();
      track.joint = joint;
      for (const Key& key : keys_) {
        track.times.push_back(key.time);
        track.values.push_back(value(key.local));
      }
    };
    replace(clip.translations, [](const Transform& local) { return Vec3f(local.translation.cast<float>()); });
    if (!changed) return;
    replace(clip.rotations, [](const Transform& local) { return Eigen::Quaternionf(local.rotation.cast<float>()); });
    auto& turns = clip.rotations.back().values;
    for (std::size_t k = 1; k < turns.size(); ++k) {
      if (turns[k].coeffs().dot(turns[k - 1].coeffs()) < 0) turns[k].coeffs() *= -1;
    }
    replace(clip.scales, [](const Transform& local) { return Vec3f(local.scale.cast<float>()); });
    Track<Vec3f>& scales = clip.scales.back();
    const Vec3f first = scales.values.front();
    const auto isFirst = [&](const Vec3f& scale) { return (scale - first).norm() <= kSameScale * first.norm(); };
    if (!std::all_of(scales.values.begin(), scales.values.end(), isFirst)) return;
    scales.times = {0};
    scales.values = {first};
  }

 private:
  struct Key {
    float time = 0;
    Transform local;
  };

  Key keyAt(float time) const { return {time, movement_(time)}; }

  // From the line between two keys.
  double distance(const Key& from, const Key& to, double time, const Transform& local) const {
    const double u = (time - from.time) / (double{to.time} - from.time);
    const Vec3 line = (1 - u) * from.local.translation + u * to.local.translation;
    return (line - local.translation).norm() / size_ +
           from.local.rotation.slerp(u, to.local.rotation).angularDistance(local.rotation);
  }

  void divide(const Key& from, const Key& to, int depth) {
    const float middle = from.time + (to.time - from.time) / 2;
    if (depth == kMostHalvings || !(middle > from.time && middle < to.time)) return;
    const Key between = keyAt(middle);
    // Of a curve that bends both ways the middle alone may lie on the line.
    const double aside = from.time + kAside * (double{to.time} - from.time);
    const double off = std::max(distance(from, to, middle, between.local), distance(from, to, aside, movement_(aside)));
    if (off <= kBetweenKeys) return;
    divide(from, between, depth + 1);
    keys_.push_back(between);
    divide(between, to, depth + 1);
  }

  const Movement& movement_;
  double size_;
  std::vector<Key> keys_;
};

double sizeOf(const Skeleton& skeleton) {
  Box box;
  for (const Affine& global : restGlobals(skeleton)) box.add(global.translation());
  return std::max(box.diagonal(), 1e-9);
}

std::vector<float> sorted(std::vector<float> times) {
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// The joints that carry the body's way: those that move, or the roots where it is held in its place.
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
  const double size = sizeOf(skeleton);
  for (const MovingRoot& root : carriersOf(skeleton, clip, body)) {
    const Affine toAbove = root.above.inverse(Eigen::Affine);
    if (!toAbove.matrix().allFinite()) continue;  // below a scale of 0 nothing shows
    const JointMovement joint(skeleton, clip, root.joint);
    std::vector<float> times = trajectory.times;
    joint.addKeys(times);
    const Movement movement = [&](double seconds) {
      return decompose(toAbove * trajectory.at(seconds).toAffine().inverse(Eigen::Isometry) * root.above *
                       joint.at(seconds).toAffine());
    };
    MovementKeys(movement, sorted(std::move(times)), size).writeTo(result, root.joint, !trajectory.headings.empty());
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
  const double size = sizeOf(skeleton);
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
    const Movement movement = [&](double seconds) {
      return decompose(toRest * trajectory.at(seconds).toAffine().inverse(Eigen::Isometry) *
                       before.at(seconds).toAffine() * joint.at(seconds).toAffine());
    };
    MovementKeys(movement, sorted(std::move(times)), size).writeTo(result, j, turns);
  }
  const Movement movement = [&](double seconds) { return decompose(trajectory.at(seconds).toAffine() * rest); };
  MovementKeys(movement, trajectory.times, size).writeTo(result, root, turns);
  return result;
}

}  // namespace limber
