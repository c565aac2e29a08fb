// What is done alike to a clip's translations, rotations and scales.
#pragma once

#include <algorithm>
#include <vector>

#include "limber/skeleton/clip/clip.h"

namespace limber {

// Calls visit(tracks) for the translations, the rotations and the scales of a clip.
template <class AnyClip, class Visit>
void forEachKind(AnyClip& clip, const Visit& visit) {
  visit(clip.translations);
  visit(clip.rotations);
  visit(clip.scales);
}

// Calls visit(track) for each, in that order.
template <class AnyClip, class Visit>
void forEachTrack(AnyClip& clip, const Visit& visit) {
  forEachKind(clip, [&](auto& tracks) {
    for (auto& track : tracks) visit(track);
  });
}

// The joint's track, null where it has none.
template <class Value>
const Track<Value>* findTrack(const std::vector<Track<Value>>& tracks, Index joint) {
  const auto found =
      std::find_if(tracks.begin(), tracks.end(), [&](const Track<Value>& track) { return track.joint == joint; });
  return found == tracks.end() ? nullptr : &*found;
}

// The joint's track; where it has none, it gets one that keeps it in rest pose.
template <class Value>
Track<Value>& trackOf(std::vector<Track<Value>>& tracks, Index joint, const Value& rest) {
  for (Track<Value>& track : tracks) {
    if (track.joint == joint) return track;
  }
  return tracks.emplace_back(Track<Value>{joint, Interpolation::kLinear, {0.0f}, {rest}});
}

inline const Vec3f& coefficientsOf(const Vec3f& value) {
  return value;
}
inline const Eigen::Vector4f& coefficientsOf(const Eigen::Quaternionf& value) {
  return value.coeffs();
}

// Whether all keys have one value, bit for bit but for the sign of zeros, and no tangent leaves it.
template <class Value>
bool isConstant(const Track<Value>& track) {
  const bool cubic = track.interpolation == Interpolation::kCubic;
  for (std::size_t v = 0; v < track.values.size(); ++v) {
    const bool isTangent = cubic && v % 3 != 1;
    const auto& numbers = coefficientsOf(track.values[v]);
    if (isTangent ? !numbers.isZero(0) : numbers != coefficientsOf(track.values[cubic ? 1 : 0])) return false;
  }
  return true;
}

// q and -q are one rotation, but the paths of interpolation to them differ: each takes the side of the one before it.
inline void keepNearSide(std::vector<Eigen::Quaternionf>& values) {
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (values[k].coeffs().dot(values[k - 1].coeffs()) < 0) values[k].coeffs() *= -1;
  }
}
inline void keepNearSide(std::vector<Vec3f>&) {}

}  // namespace limber
