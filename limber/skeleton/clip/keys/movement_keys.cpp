#include "limber/skeleton/clip/keys/movement_keys.h"

#include <algorithm>
#include <cmath>

#include "limber/core/sort_unique.h"
#include "limber/skeleton/clip/keys/key_rounding.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr float kSameScale = 5e-7f;  // relative: the same but for rounding
constexpr double kAside = 0.2113;    // of the time between two keys: where a cubic is farthest from its middle's line
constexpr int kMaxHalvings = 8;      // of the time between two keys

}  // namespace

template <typename Value>
void addKeyTimes(const Track<Value>& track, std::vector<float>& times) {
  for (const float time : track.times) {
    if (track.interpolation == Interpolation::kStep && time > 0) times.push_back(static_cast<float>(justBefore(time)));
    times.push_back(time);
  }
}
template void addKeyTimes(const Track<Vec3f>& track, std::vector<float>& times);
template void addKeyTimes(const Track<Eigen::Quaternionf>& track, std::vector<float>& times);

double sizeSeenFrom(const Skeleton& skeleton, std::optional<Index> joint) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  Box box;
  for (const Affine& global : globals) box.add(global.translation());
  const double scale = joint ? globals[*joint].linear().colwise().norm().maxCoeff() : 1;
  return std::max(box.diagonal(), 1e-9) / std::max(scale, 1e-9);
}

MovementKeys::MovementKeys(const MovingTransform& movement, std::vector<float> times, double size, double most) {
  sortUnique(times);
  for (const float time : times) {
    const Key next{time, movement(time)};
    if (!keys_.empty()) divide(movement, {size, most}, Key(keys_.back()), next, 0);
    keys_.push_back(next);
  }
}

void MovementKeys::writeTo(Clip& clip, Index joint, bool changed) const {
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
  keepNearSide(clip.rotations.back().values);
  replace(clip.scales, [](const Transform& local) { return Vec3f(local.scale.cast<float>()); });
  Track<Vec3f>& scales = clip.scales.back();
  const Vec3f first = scales.values.front();
  const auto isFirst = [&](const Vec3f& scale) { return (scale - first).norm() <= kSameScale * first.norm(); };
  if (!std::all_of(scales.values.begin(), scales.values.end(), isFirst)) return;
  scales.times = {0};
  scales.values = {first};
}

void MovementKeys::divide(const MovingTransform& movement, const Bound& bound, const Key& from, const Key& to,
                          int depth) {
  const float middle = from.time + (to.time - from.time) / 2;
  if (depth == kMaxHalvings || !(middle > from.time && middle < to.time)) return;
  const auto distance = [&](double time, const Transform& local) {
    const double u = (time - from.time) / (double{to.time} - from.time);
    const auto line = [&](const Vec3& a, const Vec3& b) { return Vec3((1 - u) * a + u * b); };
    return (line(from.local.translation, to.local.translation) - local.translation).norm() / bound.size +
           from.local.rotation.slerp(u, to.local.rotation).angularDistance(local.rotation) +
           (line(from.local.scale, to.local.scale) - local.scale).cwiseAbs().maxCoeff();
  };
  const Key between{middle, movement(middle)};
  // On a curve that bends in both directions the middle alone may lie on the line.
  const double aside = from.time + kAside * (double{to.time} - from.time);
  if (std::max(distance(middle, between.local), distance(aside, movement(aside))) <= bound.most) return;
  divide(movement, bound, from, between, depth + 1);
  keys_.push_back(between);
  divide(movement, bound, between, to, depth + 1);
}

}  // namespace limber
