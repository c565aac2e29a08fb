#include "limber/skeleton/keyframes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/core/error.h"

namespace limber {

namespace {

using Rotation = Eigen::Quaternionf;

constexpr double kAtRest = 1e-6;  // metres, radians and the like: what differs less from the rest pose is no movement

float requireTime(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) {
    throw Error(ErrorCode::kBadArgument, "a key's time is not a positive number of seconds");
  }
  return static_cast<float>(seconds);
}

// A track's keys without their tangents.
template <class Value>
struct Keys {
  std::vector<float> times;
  std::vector<Value> values;
};

template <class Value>
Keys<Value> keysOf(const Track<Value>& track) {
  if (track.interpolation != Interpolation::kCubic) return {track.times, track.values};
  Keys<Value> keys{track.times, {}};
  for (std::size_t k = 0; k < track.times.size(); ++k) keys.values.push_back(track.values[3 * k + 1]);
  return keys;
}

Vec3f slope(const Vec3f& from, const Vec3f& to, float seconds) {
  return (to - from) / seconds;
}
Rotation slope(const Rotation& from, const Rotation& to, float seconds) {
  return Rotation(Eigen::Vector4f((to.coeffs() - from.coeffs()) / seconds));
}

Vec3f noSlope(const Vec3f&) {
  return Vec3f::Zero();
}
Rotation noSlope(const Rotation&) {
  return Rotation(Eigen::Vector4f(Eigen::Vector4f::Zero()));
}

// A spline goes the short way only where neighbours lie on the same side of the sphere.
void alignSigns(std::vector<Vec3f>&) {}
void alignSigns(std::vector<Rotation>& values) {
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k - 1].dot(values[k]) < 0) values[k].coeffs() *= -1;
  }
}

template <class Value>
void putKeys(Track<Value>& track, Keys<Value> keys, Interpolation interpolation) {
  track.interpolation = interpolation;
  if (interpolation != Interpolation::kCubic) {
    track.times = std::move(keys.times);
    track.values = std::move(keys.values);
    return;
  }
  alignSigns(keys.values);
  track.values.clear();
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    const bool inside = k > 0 && k + 1 < keys.times.size();
    const Value tangent = inside ? slope(keys.values[k - 1], keys.values[k + 1], keys.times[k + 1] - keys.times[k - 1])
                                 : noSlope(keys.values[k]);
    track.values.insert(track.values.end(), {tangent, keys.values[k], tangent});
  }
  track.times = std::move(keys.times);
}

template <class Value>
std::optional<std::size_t> keyAt(const Keys<Value>& keys, float seconds) {
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    if (std::abs(keys.times[k] - seconds) < kKeySnap) return k;
  }
  return std::nullopt;
}

template <class Value>
void eraseKey(Keys<Value>& keys, std::size_t k) {
  keys.times.erase(keys.times.begin() + static_cast<std::ptrdiff_t>(k));
  keys.values.erase(keys.values.begin() + static_cast<std::ptrdiff_t>(k));
}

template <class Value>
void insertKey(Keys<Value>& keys, float seconds, const Value& value) {
  while (const std::optional<std::size_t> there = keyAt(keys, seconds)) eraseKey(keys, *there);
  const auto at = std::lower_bound(keys.times.begin(), keys.times.end(), seconds) - keys.times.begin();
  keys.times.insert(keys.times.begin() + at, seconds);
  keys.values.insert(keys.values.begin() + at, value);
}

bool differs(const Vec3f& a, const Vec3f& b) {
  return (a - b).norm() > kAtRest;
}
bool differs(const Rotation& a, const Rotation& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm()) > kAtRest;
}

// One value of one joint.
template <class Value>
void setValue(std::vector<Track<Value>>& tracks, Index joint, const Value& rest, const Value& value, float seconds,
              const std::vector<double>& others, Interpolation interpolation, bool always = false) {
  auto track = std::find_if(tracks.begin(), tracks.end(), [&](const Track<Value>& t) { return t.joint == joint; });
  if (track == tracks.end()) {
    if (!always && !differs(rest, value)) return;
    Keys<Value> keys;
    for (const double time : others) insertKey(keys, static_cast<float>(time), rest);
    tracks.push_back({joint, interpolation, {}, {}});
    track = std::prev(tracks.end());
    insertKey(keys, seconds, value);
    putKeys(*track, std::move(keys), interpolation);
    return;
  }
  Keys<Value> keys = keysOf(*track);
  insertKey(keys, seconds, value);
  putKeys(*track, std::move(keys), track->interpolation);
}

template <class Visit>
void eachKind(Clip& clip, const Visit& visit) {
  visit(clip.translations);
  visit(clip.rotations);
  visit(clip.scales);
}

template <class Value>
void collectTimes(const std::vector<Track<Value>>& tracks, std::vector<double>& times) {
  for (const Track<Value>& track : tracks) times.insert(times.end(), track.times.begin(), track.times.end());
}

// `edit` changes a track's keys and says whether it did; tracks that are left without keys go. Throws where it
// changed none.
template <class Edit>
void editKeys(Clip& clip, double seconds, const Edit& edit) {
  bool changed = false;
  eachKind(clip, [&](auto& tracks) {
    for (auto& track : tracks) {
      auto keys = keysOf(track);
      if (!edit(keys)) continue;
      changed = true;
      putKeys(track, std::move(keys), track.interpolation);
    }
    tracks.erase(std::remove_if(tracks.begin(), tracks.end(), [](const auto& track) { return track.times.empty(); }),
                 tracks.end());
  });
  if (!changed) {
    throw Error(ErrorCode::kBadArgument, "there is no key at " + std::to_string(seconds) + " s", clip.name);
  }
}

}  // namespace

std::vector<double> keyTimes(const Clip& clip) {
  std::vector<double> times, kept;
  collectTimes(clip.translations, times);
  collectTimes(clip.rotations, times);
  collectTimes(clip.scales, times);
  std::sort(times.begin(), times.end());
  for (const double time : times) {
    if (kept.empty() || time - kept.back() >= kKeySnap) kept.push_back(time);
  }
  return kept;
}

Interpolation interpolationOf(const Clip& clip) {
  if (!clip.rotations.empty()) return clip.rotations.front().interpolation;
  if (!clip.translations.empty()) return clip.translations.front().interpolation;
  return clip.scales.empty() ? Interpolation::kLinear : clip.scales.front().interpolation;
}

void setKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds) {
  const float time = requireTime(seconds);
  if (pose.locals.size() != skeleton.joints.size()) {
    throw Error(ErrorCode::kBadArgument, "the pose is of another skeleton", clip.name);
  }
  const std::vector<double> others = keyTimes(clip);
  const Interpolation interpolation = interpolationOf(clip);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Transform &rest = skeleton.joints[j].rest, &now = pose.locals[j];
    setValue<Vec3f>(clip.translations, j, rest.translation.cast<float>(), now.translation.cast<float>(), time, others,
                    interpolation);
    setValue<Rotation>(clip.rotations, j, rest.rotation.cast<float>(), now.rotation.cast<float>().normalized(), time,
                       others, interpolation, !skeleton.joints[j].parent);
    setValue<Vec3f>(clip.scales, j, rest.scale.cast<float>(), now.scale.cast<float>(), time, others, interpolation);
  }
}

void blendKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds, double span) {
  if (!(span >= 0) || !std::isfinite(span))
    throw Error(ErrorCode::kBadArgument, "a span is 0 seconds or more", clip.name);
  const auto poseAt = [&](double time) {
    Pose at = restPose(skeleton);
    sampleClip(clip, time, at);
    return at;
  };
  std::vector<std::pair<double, Pose>> blended;
  if (pose.locals.size() == skeleton.joints.size() && span > 0) {
    const Pose before = poseAt(seconds);
    for (const double time : keyTimes(clip)) {
      const double away = std::abs(time - seconds) / span;
      if (away >= 1 || std::abs(time - seconds) < kKeySnap) continue;
      const double share = 1 - away * away * (3 - 2 * away);
      Pose& at = blended.emplace_back(time, poseAt(time)).second;
      for (std::size_t j = 0; j < at.locals.size(); ++j) {
        const Transform &from = before.locals[j], &to = pose.locals[j];
        const Quat turn = from.rotation.conjugate() * to.rotation;
        at.locals[j].translation += share * (to.translation - from.translation);
        at.locals[j].rotation = (at.locals[j].rotation * Quat::Identity().slerp(share, turn)).normalized();
        at.locals[j].scale += share * (to.scale - from.scale);
      }
    }
  }
  setKey(clip, skeleton, pose, seconds);
  for (const auto& [time, at] : blended) setKey(clip, skeleton, at, time);
}

void moveKey(Clip& clip, double from, double to) {
  const float start = requireTime(from), end = requireTime(to);
  editKeys(clip, from, [&](auto& keys) {
    const std::optional<std::size_t> key = keyAt(keys, start);
    if (!key) return false;
    const auto value = keys.values[*key];
    eraseKey(keys, *key);
    insertKey(keys, end, value);
    return true;
  });
}

void deleteKey(Clip& clip, double seconds) {
  const float time = requireTime(seconds);
  editKeys(clip, seconds, [&](auto& keys) {
    const std::optional<std::size_t> key = keyAt(keys, time);
    if (key) eraseKey(keys, *key);
    return key.has_value();
  });
}

void setInterpolation(Clip& clip, Interpolation interpolation) {
  eachKind(clip, [&](auto& tracks) {
    for (auto& track : tracks) {
      if (track.interpolation != interpolation) putKeys(track, keysOf(track), interpolation);
    }
  });
}

}  // namespace limber
