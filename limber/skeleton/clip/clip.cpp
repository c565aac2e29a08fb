#include "limber/skeleton/clip/clip.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/skeleton/clip/keys/key_rounding.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

constexpr float kUnitTolerance = 1e-3f;

bool isFinite(const Vec3f& v) {
  return v.allFinite();
}

bool isFinite(const Eigen::Quaternionf& q) {
  return q.coeffs().allFinite();
}

bool isValid(const Vec3f& v) {
  return v.allFinite();
}

bool isValid(const Eigen::Quaternionf& q) {
  return std::abs(q.norm() - 1.0f) <= kUnitTolerance;
}

template <typename Value>
void checkTracks(const std::vector<Track<Value>>& tracks, const char* kind, const Skeleton& skeleton) {
  std::vector<bool> seen(skeleton.jointCount(), false);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    const Track<Value>& track = tracks[t];
    const auto bad = [&](const std::string& what) {
      throw Error(ErrorCode::kBadData, what, fmt::format("{} track {}", kind, t));
    };
    if (track.joint >= skeleton.jointCount()) bad(fmt::format("is for joint {}, which is not there", track.joint));
    if (seen[track.joint]) bad("is the second for joint '" + skeleton.joints[track.joint].name + "'");
    seen[track.joint] = true;
    const bool cubic = track.interpolation == Interpolation::kCubic;
    if (track.times.empty()) bad("has no key");
    if (track.values.size() != track.times.size() * (cubic ? 3 : 1)) {
      bad(fmt::format("has {} values for {} keys", track.values.size(), track.times.size()));
    }
    for (std::size_t k = 0; k < track.times.size(); ++k) {
      if (!std::isfinite(track.times[k])) bad(fmt::format("has a time that is not finite at key {}", k));
      if (k > 0 && !(track.times[k] > track.times[k - 1])) bad(fmt::format("goes back in time at key {}", k));
    }
    for (std::size_t v = 0; v < track.values.size(); ++v) {
      const bool tangent = cubic && v % 3 != 1;
      if (tangent ? !isFinite(track.values[v]) : !isValid(track.values[v])) bad(fmt::format("has a bad value {}", v));
    }
  }
}

Vec3 blend(const Vec3f& a, const Vec3f& b, double u) {
  return (1 - u) * a.cast<double>() + u * b.cast<double>();
}

Quat blend(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b, double u) {
  return a.cast<double>().normalized().slerp(u, b.cast<double>().normalized());
}

Vec3 fromCoefficients(const Vec3& v, const Vec3f&) {
  return v;
}

Quat fromCoefficients(const Vec4& v, const Eigen::Quaternionf&) {
  return Quat(v).normalized();
}

template <typename Value>
auto coefficients(const Value& value) {
  return coefficientsOf(value).template cast<double>().eval();
}

template <typename Value>
auto hermite(const Track<Value>& track, std::size_t k, double span, double u) {
  const double u2 = u * u, u3 = u2 * u;
  const auto& v = track.values;
  const auto sum =
      ((2 * u3 - 3 * u2 + 1) * coefficients(v[3 * k + 1]) + span * (u3 - 2 * u2 + u) * coefficients(v[3 * k + 2]) +
       (3 * u2 - 2 * u3) * coefficients(v[3 * k + 4]) + span * (u3 - u2) * coefficients(v[3 * k + 3]))
          .eval();
  return fromCoefficients(sum, v[0]);
}

template <typename Value>
auto valueAt(const Track<Value>& track, double seconds) {
  const bool cubic = track.interpolation == Interpolation::kCubic;
  const double rounding = track.interpolation == Interpolation::kStep ? keyRounding(seconds) : 0;
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), seconds + rounding,
                                     [](double time, float key) { return time < key; });
  const std::size_t after = static_cast<std::size_t>(next - track.times.begin());
  const std::size_t before = after == 0 ? 0 : after - 1;
  if (after == 0 || after == track.times.size() || track.interpolation == Interpolation::kStep) {
    const Value& value = track.values[cubic ? 3 * before + 1 : before];
    return fromCoefficients(coefficients(value), value);
  }
  const double span = double{track.times[after]} - track.times[before];
  const double u = (seconds - track.times[before]) / span;
  if (cubic) return hermite(track, before, span, u);
  return blend(track.values[before], track.values[after], u);
}

}  // namespace

Vec3 sampleTrack(const Track<Vec3f>& track, double seconds) {
  return valueAt(track, seconds);
}

Quat sampleTrack(const Track<Eigen::Quaternionf>& track, double seconds) {
  return valueAt(track, seconds);
}

double Clip::duration() const {
  double last = 0;
  forEachTrack(*this, [&](const auto& track) {
    if (!track.times.empty()) last = std::max(last, double{track.times.back()});
  });
  return last;
}

void checkClip(const Clip& clip, const Skeleton& skeleton) {
  checkTracks(clip.translations, "translation", skeleton);
  checkTracks(clip.rotations, "rotation", skeleton);
  checkTracks(clip.scales, "scale", skeleton);
}

void sampleClip(const Clip& clip, double seconds, Pose& pose) {
  for (const auto& track : clip.translations) pose.locals[track.joint].translation = sampleTrack(track, seconds);
  for (const auto& track : clip.rotations) pose.locals[track.joint].rotation = sampleTrack(track, seconds);
  for (const auto& track : clip.scales) pose.locals[track.joint].scale = sampleTrack(track, seconds);
}

}  // namespace limber
