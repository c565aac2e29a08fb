#include "limber/skeleton/clip/clip_layer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/clip/keys/retime_keys.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr double kNoOffset = 1e-6;  // metres and radians: what differs less is the same

struct LayerOffset {
  Vec3 translation = Vec3::Zero();
  Quat rotation = Quat::Identity();
};

double easeInOut(double u) {
  return u * u * (3 - 2 * u);
}

LayerOffset blend(const LayerKey& from, const LayerKey& to, double weight) {
  return {from.translation + weight * (to.translation - from.translation), from.rotation.slerp(weight, to.rotation)};
}

LayerOffset faded(const LayerKey& key, double seconds) {
  const double away = std::abs(seconds - key.seconds);
  if (away < kKeySnap) return {key.translation, key.rotation};
  const double weight = away < key.span ? 1 - easeInOut(away / key.span) : 0;
  return {weight * key.translation, Quat::Identity().slerp(weight, key.rotation)};
}

bool meet(const LayerKey& a, const LayerKey& b) {
  return b.seconds - a.seconds <= a.span + b.span;
}

LayerOffset offsetAt(const std::vector<LayerKey>& keys, double seconds) {
  const auto next = std::find_if(keys.begin(), keys.end(), [&](const LayerKey& key) { return key.seconds > seconds; });
  if (next == keys.begin()) return faded(*next, seconds);
  const LayerKey& before = *std::prev(next);
  if (next == keys.end()) return faded(before, seconds);
  if (meet(before, *next)) {
    return blend(before, *next, easeInOut((seconds - before.seconds) / (next->seconds - before.seconds)));
  }
  return seconds - before.seconds < before.span ? faded(before, seconds) : faded(*next, seconds);
}

// Stretches of time in which a track says something.
std::vector<std::pair<double, double>> reachOf(const std::vector<LayerKey>& keys) {
  std::vector<std::pair<double, double>> reach;
  for (const LayerKey& key : keys) {
    const double from = std::max(0.0, key.seconds - key.span), to = key.seconds + key.span;
    if (!reach.empty() && from <= reach.back().second) {
      reach.back().second = std::max(reach.back().second, to);
    } else {
      reach.emplace_back(from, to);
    }
  }
  return reach;
}

// Where the offset begins and ends, moments of the clip's frames in between, the layer's keys, and what it takes to
// have kLayerRate of them a second. The clip does not get longer.
std::vector<double> bakedTimes(const std::vector<LayerKey>& keys, const std::vector<double>& frames, double duration) {
  constexpr double kMaxGap = 1.01 / kLayerRate;
  std::vector<double> times;
  for (const auto& [from, end] : reachOf(keys)) {
    const double to = std::min(end, duration);
    if (from > to) continue;
    std::vector<double> inside = {from, to};
    for (const double frame : frames) {
      if (frame > from && frame < to) inside.push_back(frame);
    }
    for (const LayerKey& key : keys) {
      if (key.seconds > from && key.seconds < to) inside.push_back(key.seconds);
    }
    std::sort(inside.begin(), inside.end());
    for (std::size_t k = 0; k + 1 < inside.size(); ++k) {
      const double gap = inside[k + 1] - inside[k];
      const int steps = std::max(1, static_cast<int>(std::ceil(gap / kMaxGap)));
      for (int s = 0; s < steps; ++s) times.push_back(inside[k] + gap * s / steps);
    }
    times.push_back(to);
  }
  return times;
}

Vec3f singles(const Vec3& value) {
  return value.cast<float>();
}
Eigen::Quaternionf singles(const Quat& value) {
  return value.cast<float>().normalized();
}

template <class Value>
const Value& valueOfKey(const Track<Value>& track, std::size_t k) {
  return track.values[track.interpolation == Interpolation::kCubic ? 3 * k + 1 : k];
}

// The track (`rest` where there is none) with `change(value, seconds)` at each of `times`, and at its own keys that lie
// in the layer's reach; those outside stay, bit for bit.
template <class Value, class Wide, class Change>
Track<Value> changedTrack(const Track<Value>* track, const LayerTrack& layer, const Wide& rest,
                          const std::vector<double>& times, const Change& change) {
  constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::vector<std::pair<double, std::size_t>> samples;  // which key of its own
  for (std::size_t k = 0; track && k < track->times.size(); ++k) samples.emplace_back(track->times[k], k);
  for (const double time : times) samples.emplace_back(time, kNone);
  std::sort(samples.begin(), samples.end());
  const auto reach = reachOf(layer.keys);
  const auto reached = [&](double seconds) {
    return std::any_of(reach.begin(), reach.end(), [&](const auto& part) {
      return seconds > part.first - kKeySnap && seconds < part.second + kKeySnap;
    });
  };
  Track<Value> result;
  result.joint = layer.joint;
  for (const auto& [seconds, own] : samples) {
    const auto time = static_cast<float>(seconds);
    if (!result.times.empty() && time - result.times.back() < kKeySnap) {
      if (own == kNone) continue;  // a key of its own counts more
      result.times.pop_back();
      result.values.pop_back();
    }
    result.times.push_back(time);
    if (own != kNone && !reached(seconds)) {
      result.values.push_back(valueOfKey(*track, own));
    } else {
      result.values.push_back(singles(change(track ? sampleTrack(*track, seconds) : rest, seconds)));
    }
  }
  return result;
}

template <class Value>
void putTrack(std::vector<Track<Value>>& tracks, Track<Value> track) {
  const auto at =
      std::find_if(tracks.begin(), tracks.end(), [&](const Track<Value>& known) { return known.joint == track.joint; });
  if (at == tracks.end()) {
    tracks.push_back(std::move(track));
  } else {
    *at = std::move(track);
  }
}

bool layerTurns(const LayerTrack& track) {
  return std::any_of(track.keys.begin(), track.keys.end(),
                     [](const LayerKey& key) { return key.rotation.angularDistance(Quat::Identity()) > kNoOffset; });
}

bool layerShifts(const LayerTrack& track) {
  return std::any_of(track.keys.begin(), track.keys.end(),
                     [](const LayerKey& key) { return key.translation.norm() > kNoOffset; });
}

bool sameLocal(const Transform& a, const Transform& b) {
  return (a.translation - b.translation).norm() <= kNoOffset && a.rotation.angularDistance(b.rotation) <= kNoOffset;
}

LayerTrack& layerTrackOf(ClipLayer& layer, Index joint) {
  const auto at = std::lower_bound(layer.tracks.begin(), layer.tracks.end(), joint,
                                   [](const LayerTrack& track, Index wanted) { return track.joint < wanted; });
  return at != layer.tracks.end() && at->joint == joint ? *at : *layer.tracks.insert(at, {joint, {}});
}

void putLayerKey(LayerTrack& track, const LayerKey& key) {
  std::erase_if(track.keys, [&](const LayerKey& known) { return std::abs(known.seconds - key.seconds) < kKeySnap; });
  const auto at = std::lower_bound(track.keys.begin(), track.keys.end(), key,
                                   [](const LayerKey& a, const LayerKey& b) { return a.seconds < b.seconds; });
  track.keys.insert(at, key);
}

void requireNotNegative(double seconds, const char* what) {
  if (std::isfinite(seconds) && seconds >= 0) return;
  throw Error(ErrorCode::kBadArgument, fmt::format("{} is not a positive number of seconds", what));
}

}  // namespace

Clip applyLayer(const Clip& clip, const ClipLayer& layer, const Skeleton& skeleton) {
  Clip result = clip;
  const std::vector<double> frames = keyTimes(clip);
  const double duration = clip.duration();
  for (const LayerTrack& track : layer.tracks) {
    const Transform& rest = skeleton.joints[track.joint].rest;
    const std::vector<double> times = bakedTimes(track.keys, frames, duration);
    if (layerTurns(track)) {
      putTrack(result.rotations,
               changedTrack<Eigen::Quaternionf>(findTrack(clip.rotations, track.joint), track, rest.rotation, times,
                                                [&](const Quat& value, double seconds) -> Quat {
                                                  const LayerOffset offset = offsetAt(track.keys, seconds);
                                                  return value * offset.rotation;
                                                }));
    }
    if (layerShifts(track)) {
      putTrack(result.translations,
               changedTrack<Vec3f>(findTrack(clip.translations, track.joint), track, rest.translation, times,
                                   [&](const Vec3& value, double seconds) -> Vec3 {
                                     return value + offsetAt(track.keys, seconds).translation;
                                   }));
    }
  }
  const Interpolation between = interpolationOf(clip);
  if (between != Interpolation::kLinear) setInterpolation(result, between);
  return result;
}

void setKey(ClipLayer& layer, const Pose& base, const Pose& shown, const Pose& pose, double seconds, double span) {
  requireNotNegative(seconds, "a key's time");
  requireNotNegative(span, "a span");
  if (pose.locals.size() != base.locals.size() || pose.locals.size() != shown.locals.size()) {
    throw Error(ErrorCode::kBadArgument, "the pose is of another skeleton");
  }
  const auto keyFor = [&](Index joint) {
    const Transform &below = base.locals[joint], &wanted = pose.locals[joint];
    return LayerKey{seconds, span, wanted.translation - below.translation,
                    (below.rotation.conjugate() * wanted.rotation).normalized()};
  };
  bool differs = false;
  for (Index joint = 0; joint < pose.locals.size(); ++joint) {
    if (sameLocal(pose.locals[joint], shown.locals[joint])) continue;
    putLayerKey(layerTrackOf(layer, joint), keyFor(joint));
    differs = true;
  }
  if (differs) return;
  for (LayerTrack& track : layer.tracks) putLayerKey(track, keyFor(track.joint));
}

std::vector<double> keyTimes(const ClipLayer& layer) {
  std::vector<double> times;
  for (const LayerTrack& track : layer.tracks) {
    for (const LayerKey& key : track.keys) times.push_back(key.seconds);
  }
  return eachOnce(std::move(times));
}

std::vector<JointKeyTimes> keyTimesOfJoints(const ClipLayer& layer) {
  std::vector<JointKeyTimes> list;
  for (const LayerTrack& track : layer.tracks) {
    list.push_back({track.joint, {}});
    for (const LayerKey& key : track.keys) list.back().seconds.push_back(key.seconds);
  }
  return list;
}

void retimeKeys(ClipLayer& layer, std::span<const JointKey> keys, const KeyRetiming& retiming) {
  requireKeys(keyTimesOfJoints(layer), keys);
  checkRetiming(keys, retiming);
  for (LayerTrack& track : layer.tracks) {
    retime(
        track.keys, [&](double seconds) { return isChosen(keys, track.joint, seconds); }, retiming);
  }
}

void deleteKeys(ClipLayer& layer, std::span<const JointKey> keys) {
  requireKeys(keyTimesOfJoints(layer), keys);
  for (LayerTrack& track : layer.tracks) {
    std::erase_if(track.keys, [&](const LayerKey& key) { return isChosen(keys, track.joint, key.seconds); });
  }
  std::erase_if(layer.tracks, [](const LayerTrack& track) { return track.keys.empty(); });
}

}  // namespace limber
