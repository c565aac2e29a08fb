#include "limber/skeleton/clip/clip_edit.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/clip/tracks.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr double kCutCurveRate = 120;  // keys a second of a curve that becomes lines

Vec3f stored(const Vec3& value) {
  return value.cast<float>();
}
Eigen::Quaternionf stored(const Quat& value) {
  return value.cast<float>();
}

std::vector<float> frameTimes(double duration, double rate, Index frames) {
  constexpr double kRounding = 1e-3;  // of a frame: key times are rounded, and the end is a frame, too
  if (std::abs((frames - 1) / rate - duration) * rate < kRounding) duration = (frames - 1) / rate;
  std::vector<float> times;
  for (Index k = 0; k < frames; ++k) times.push_back(static_cast<float>(std::min(k / rate, duration)));
  const auto last = static_cast<float>(duration);
  if (times.back() < last) times.push_back(last);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// A constant value is constant from the start.
template <typename Value>
Track<Value> fromStart(Track<Value> track) {
  track.times = {0};
  return track;
}

template <typename Value>
Track<Value> sampled(const Track<Value>& track, const std::vector<float>& times) {
  if (track.times.size() == 1) return fromStart(track);
  Track<Value> result;
  result.joint = track.joint;
  result.times = times;
  for (const float time : times) result.values.push_back(stored(sampleTrack(track, time)));
  keepNearSide(result.values);
  return result;
}

// The curve's speed at `seconds`, which lies between keys k and k + 1 (Hermite, its derivative).
Vec3f slopeAt(const Track<Vec3f>& track, std::size_t k, double seconds) {
  const double span = double{track.times[k + 1]} - track.times[k], u = (seconds - track.times[k]) / span;
  const auto value = [&](std::size_t i) { return Vec3(track.values[i].cast<double>()); };
  const Vec3 slope = (6 * u * u - 6 * u) / span * (value(3 * k + 1) - value(3 * k + 4)) +
                     (3 * u * u - 4 * u + 1) * value(3 * k + 2) + (3 * u * u - 2 * u) * value(3 * k + 3);
  return slope.cast<float>();
}

template <typename Value>
bool hasKeyAt(const Track<Value>& track, double seconds) {
  return seconds <= track.times.front() || seconds >= track.times.back() ||
         std::binary_search(track.times.begin(), track.times.end(), static_cast<float>(seconds));
}

// Three values of a key of a cubic track at any moment.
template <typename Value>
void addCubicKey(const Track<Value>& track, double seconds, Track<Value>& result) {
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), static_cast<float>(seconds));
  const auto k = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - track.times.begin() - 1));
  const bool inside = next != track.times.end() && next != track.times.begin() && track.times[k] < seconds;
  if (inside) {
    if constexpr (std::is_same_v<Value, Vec3f>) {
      const Vec3f slope = slopeAt(track, k, seconds);
      result.values.insert(result.values.end(), {slope, stored(sampleTrack(track, seconds)), slope});
    }
  } else if (seconds < track.times.front() || seconds > track.times.back()) {
    Value still = track.values[1];
    if constexpr (std::is_same_v<Value, Vec3f>) {
      still.setZero();
    } else {
      still.coeffs().setZero();
    }
    result.values.insert(result.values.end(), {still, stored(sampleTrack(track, seconds)), still});
  } else {
    result.values.insert(result.values.end(), {track.values[3 * k], track.values[3 * k + 1], track.values[3 * k + 2]});
  }
}

template <typename Value>
Track<Value> trimmed(const Track<Value>& track, double from, double to) {
  if (track.times.size() == 1) return fromStart(track);
  std::vector<float> times = {static_cast<float>(from)};
  for (const float time : track.times) {
    if (time > times.front() && time < static_cast<float>(to)) times.push_back(time);
  }
  times.push_back(static_cast<float>(to));
  const bool cubic = track.interpolation == Interpolation::kCubic;
  const bool curveCut =
      cubic && std::is_same_v<Value, Eigen::Quaternionf> && !(hasKeyAt(track, from) && hasKeyAt(track, to));
  Track<Value> result;
  if (curveCut) {
    const auto steps = static_cast<Index>(std::ceil((to - from) * kCutCurveRate));
    times.clear();
    for (Index k = 0; k <= steps; ++k) times.push_back(static_cast<float>(from + (to - from) * k / steps));
    times.erase(std::unique(times.begin(), times.end()), times.end());
  } else {
    result.interpolation = track.interpolation;
  }
  result.joint = track.joint;
  for (const float time : times) {
    if (cubic && !curveCut) {
      addCubicKey(track, time, result);
    } else {
      result.values.push_back(stored(sampleTrack(track, time)));
    }
    result.times.push_back(static_cast<float>(double{time} - times.front()));
  }
  if (!cubic || curveCut) keepNearSide(result.values);
  return result;
}

template <typename Change>
Clip changed(const Clip& clip, const Change& change) {
  Clip result;
  result.name = clip.name;
  for (const auto& track : clip.translations) result.translations.push_back(change(track));
  for (const auto& track : clip.rotations) result.rotations.push_back(change(track));
  for (const auto& track : clip.scales) result.scales.push_back(change(track));
  return result;
}

}  // namespace

Clip resampleClip(const Clip& clip, double framesPerSecond) {
  const std::vector<float> times = frameTimes(clip.duration(), framesPerSecond, frameCount(clip, framesPerSecond));
  return changed(clip, [&](const auto& track) { return sampled(track, times); });
}

Clip trimClip(const Clip& clip, double from, double to) {
  if (clip.duration() == 0 && from <= 0 && to > 0) return clip;  // a pose
  const double begin = std::max(from, 0.0), end = std::min(to, clip.duration());
  if (!(begin < end)) {
    const std::string span =
        std::isfinite(to) ? fmt::format("between {:g} and {:g} s", from, to) : fmt::format("after {:g} s", from);
    throw Error(ErrorCode::kBadArgument, "nothing of it lies " + span, fmt::format("clip '{}'", clip.name),
                fmt::format("it lasts {:g} s", clip.duration()));
  }
  return changed(clip, [&](const auto& track) { return trimmed(track, begin, end); });
}

Track<Vec3f> trimTrack(const Track<Vec3f>& track, double from, double to) {
  return trimmed(track, from, to);
}

Track<Eigen::Quaternionf> trimTrack(const Track<Eigen::Quaternionf>& track, double from, double to) {
  return trimmed(track, from, to);
}

Clip turnClip(Clip clip, const Skeleton& skeleton, const Quat& turn) {
  if (turn.coeffs() == Quat::Identity().coeffs()) return clip;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (skeleton.joints[j].parent) continue;
    const Transform& rest = skeleton.joints[j].rest;
    const Eigen::Quaternionf rotation = rest.rotation.cast<float>();
    const Vec3f translation = rest.translation.cast<float>();
    for (Eigen::Quaternionf& value : trackOf(clip.rotations, j, rotation).values) {
      value = (turn * value.cast<double>()).cast<float>();
    }
    for (Vec3f& value : trackOf(clip.translations, j, translation).values) {
      value = (turn * value.cast<double>()).cast<float>();
    }
  }
  return clip;
}

Pose blendPoses(const Pose& a, const Pose& b, double weight) {
  Pose result = a;
  for (std::size_t j = 0; j < a.locals.size(); ++j) {
    Transform& local = result.locals[j];
    local.translation += weight * (b.locals[j].translation - local.translation);
    local.rotation = local.rotation.slerp(weight, b.locals[j].rotation);
    local.scale += weight * (b.locals[j].scale - local.scale);
  }
  return result;
}

}  // namespace limber
