#include "limber/skeleton/clip/keys/keyframes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/skeleton/clip/keys/retime_keys.h"
#include "limber/skeleton/clip/tracks.h"

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

template <class Value>
struct Tangents {
  Value in, out;
};

// A track's keys, each with its tangents where they are not the spline's.
template <class Value>
struct Keys {
  std::vector<float> times;
  std::vector<Value> values;
  std::vector<std::optional<Tangents<Value>>> tangents;
};

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

Vec3f scaled(const Vec3f& slope, float by) {
  return slope * by;
}
Rotation scaled(const Rotation& slope, float by) {
  return Rotation(Eigen::Vector4f(slope.coeffs() * by));
}

// A spline takes the shortest path only where neighbours lie on the same side of the sphere.
void alignSigns(Keys<Vec3f>&) {}
void alignSigns(Keys<Rotation>& keys) {
  for (std::size_t k = 1; k < keys.values.size(); ++k) {
    if (!(keys.values[k - 1].dot(keys.values[k]) < 0)) continue;
    keys.values[k].coeffs() *= -1;
    if (auto& own = keys.tangents[k]) own = {scaled(own->in, -1), scaled(own->out, -1)};
  }
}

// Of the spline through the keys, which have aligned signs.
template <class Value>
Value splineSlope(const Keys<Value>& keys, std::size_t k) {
  const bool inside = k > 0 && k + 1 < keys.times.size();
  return inside ? slope(keys.values[k - 1], keys.values[k + 1], keys.times[k + 1] - keys.times[k - 1])
                : noSlope(keys.values[k]);
}

template <class Value>
bool sameSlope(const Value& a, const Value& b) {
  constexpr double kRounding = 1e-4;
  const double difference = coefficientsOf(slope(a, b, 1)).norm();
  return difference <= kRounding * (1 + double{coefficientsOf(b).norm()});
}

template <class Value>
Keys<Value> keysOf(const Track<Value>& track) {
  const std::size_t count = track.times.size();
  Keys<Value> keys{track.times, {}, std::vector<std::optional<Tangents<Value>>>(count)};
  if (track.interpolation != Interpolation::kCubic) {
    keys.values = track.values;
    return keys;
  }
  for (std::size_t k = 0; k < count; ++k) {
    keys.values.push_back(track.values[3 * k + 1]);
    keys.tangents[k] = {track.values[3 * k], track.values[3 * k + 2]};
  }
  alignSigns(keys);
  for (std::size_t k = 0; k < count; ++k) {
    const Value spline = splineSlope(keys, k);
    if (sameSlope(keys.tangents[k]->in, spline) && sameSlope(keys.tangents[k]->out, spline)) keys.tangents[k].reset();
  }
  return keys;
}

template <class Value>
void putKeys(Track<Value>& track, Keys<Value> keys, Interpolation interpolation) {
  track.interpolation = interpolation;
  if (interpolation != Interpolation::kCubic) {
    track.times = std::move(keys.times);
    track.values = std::move(keys.values);
    return;
  }
  alignSigns(keys);
  track.values.clear();
  for (std::size_t k = 0; k < keys.times.size(); ++k) {
    const Value spline = splineSlope(keys, k);
    const Tangents<Value> tangents = keys.tangents[k].value_or(Tangents<Value>{spline, spline});
    track.values.insert(track.values.end(), {tangents.in, keys.values[k], tangents.out});
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
  keys.tangents.erase(keys.tangents.begin() + static_cast<std::ptrdiff_t>(k));
}

template <class Value>
void insertKey(Keys<Value>& keys, float seconds, const Value& value,
               const std::optional<Tangents<Value>>& tangents = std::nullopt) {
  while (const std::optional<std::size_t> there = keyAt(keys, seconds)) eraseKey(keys, *there);
  const auto at = std::lower_bound(keys.times.begin(), keys.times.end(), seconds) - keys.times.begin();
  keys.times.insert(keys.times.begin() + at, seconds);
  keys.values.insert(keys.values.begin() + at, value);
  keys.tangents.insert(keys.tangents.begin() + at, tangents);
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
  const std::optional<std::size_t> known = keyAt(keys, seconds);
  const std::optional<Tangents<Value>> tangents = known ? keys.tangents[*known] : std::nullopt;
  insertKey(keys, seconds, value, tangents);
  putKeys(*track, std::move(keys), track->interpolation);
}

}  // namespace

std::vector<double> eachOnce(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  std::vector<double> kept;
  for (const double time : times) {
    if (kept.empty() || time - kept.back() >= kKeySnap) kept.push_back(time);
  }
  return kept;
}

std::vector<double> keyTimes(const Clip& clip) {
  std::vector<double> times;
  forEachTrack(clip, [&](const auto& track) { times.insert(times.end(), track.times.begin(), track.times.end()); });
  return eachOnce(std::move(times));
}

Interpolation interpolationOf(const Clip& clip) {
  if (!clip.rotations.empty()) return clip.rotations.front().interpolation;
  if (!clip.translations.empty()) return clip.translations.front().interpolation;
  return clip.scales.empty() ? Interpolation::kLinear : clip.scales.front().interpolation;
}

namespace {

// `others` and `interpolation` are for parts that have no track yet.
void setLocal(Clip& clip, const Skeleton& skeleton, Index joint, const Transform& local, float time,
              const std::vector<double>& others, Interpolation interpolation) {
  const Transform& rest = skeleton.joints[joint].rest;
  setValue<Vec3f>(clip.translations, joint, rest.translation.cast<float>(), local.translation.cast<float>(), time,
                  others, interpolation);
  setValue<Rotation>(clip.rotations, joint, rest.rotation.cast<float>(), local.rotation.cast<float>().normalized(),
                     time, others, interpolation, !skeleton.joints[joint].parent);
  setValue<Vec3f>(clip.scales, joint, rest.scale.cast<float>(), local.scale.cast<float>(), time, others, interpolation);
}

}  // namespace

void setKey(Clip& clip, const Skeleton& skeleton, const Pose& pose, double seconds) {
  const float time = requireTime(seconds);
  if (pose.locals.size() != skeleton.joints.size()) {
    throw Error(ErrorCode::kBadArgument, "the pose is of another skeleton", clip.name);
  }
  const std::vector<double> others = keyTimes(clip);
  const Interpolation interpolation = interpolationOf(clip);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    setLocal(clip, skeleton, j, pose.locals[j], time, others, interpolation);
  }
}

Clip clipOfKeys(const Skeleton& skeleton, std::span<const Pose> poses, std::span<const double> seconds) {
  Clip clip;
  std::vector<float> times;
  std::vector<std::size_t> frames;
  for (std::size_t f = 0; f < poses.size(); ++f) {
    const float time = requireTime(seconds[f]);
    if (!times.empty() && time - times.back() < kKeySnap) {
      times.pop_back();
      frames.pop_back();
    }
    times.push_back(time);
    frames.push_back(f);
  }
  const auto add = [&](auto& tracks, Index joint, const auto& rest, bool isKept, const auto& part) {
    Keys<std::decay_t<decltype(rest)>> keys{times, {}, {times.size(), std::nullopt}};
    for (const std::size_t frame : frames) {
      keys.values.push_back(part(poses[frame].locals[joint]));
      isKept = isKept || differs(rest, keys.values.back());
    }
    if (!isKept || times.empty()) return;
    alignSigns(keys);
    putKeys(tracks.emplace_back(), std::move(keys), Interpolation::kLinear);
    tracks.back().joint = joint;
  };
  const auto translation = [](const Transform& local) { return Vec3f(local.translation.cast<float>()); };
  const auto rotation = [](const Transform& local) { return Rotation(local.rotation.cast<float>().normalized()); };
  const auto scale = [](const Transform& local) { return Vec3f(local.scale.cast<float>()); };
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Transform& rest = skeleton.joints[j].rest;
    add(clip.translations, j, translation(rest), false, translation);
    add(clip.rotations, j, rotation(rest), !skeleton.joints[j].parent, rotation);
    add(clip.scales, j, scale(rest), false, scale);
  }
  return clip;
}

void setJointKey(Clip& clip, const Skeleton& skeleton, Index joint, const Transform& local, double seconds) {
  setLocal(clip, skeleton, joint, local, requireTime(seconds), keyTimes(clip), interpolationOf(clip));
}

void setInterpolation(Clip& clip, Interpolation interpolation) {
  forEachTrack(clip, [&](auto& track) {
    if (track.interpolation != interpolation) putKeys(track, keysOf(track), interpolation);
  });
}

namespace {

// `act` gets each cubic track of the joint that has a key there, its keys, and which of them it is.
template <class Tracks, class Act>
bool eachCubicKey(Tracks& tracks, const JointKey& key, const Act& act) {
  bool any = false;
  for (auto& track : tracks) {
    if (track.joint != key.joint || track.interpolation != Interpolation::kCubic) continue;
    auto keys = keysOf(track);
    const std::optional<std::size_t> at = keyAt(keys, static_cast<float>(key.seconds));
    if (!at) continue;
    act(track, keys, *at);
    any = true;
  }
  return any;
}

template <class Value>
KeyTangents kindOf(const std::optional<Tangents<Value>>& tangents) {
  if (!tangents) return KeyTangents::kAuto;
  const Value none = noSlope(tangents->in);
  const bool flat = sameSlope(tangents->in, none) && sameSlope(tangents->out, none);
  return flat ? KeyTangents::kFlat : KeyTangents::kFree;
}

// Those that a key is to have from then on.
template <class Value>
std::optional<Tangents<Value>> tangentsOf(KeyTangents kind, const Value& slope) {
  if (kind == KeyTangents::kAuto) return std::nullopt;
  const Value tangent = kind == KeyTangents::kFlat ? noSlope(slope) : slope;
  return Tangents<Value>{tangent, tangent};
}

}  // namespace

std::optional<KeySlope> slopeAt(const Clip& clip, const JointKey& key) {
  KeySlope slope;
  const auto outOf = [](const auto& keys, std::size_t at) {
    return keys.tangents[at] ? keys.tangents[at]->out : splineSlope(keys, at);
  };
  // What was set by hand on one of its tracks was set on all.
  const auto addKind = [&](KeyTangents kind) {
    if (kind != KeyTangents::kAuto) slope.tangents = kind;
  };
  const bool moves = eachCubicKey(clip.translations, key, [&](const auto&, const auto& keys, std::size_t at) {
    slope.translation = outOf(keys, at).template cast<double>();
    addKind(kindOf(keys.tangents[at]));
  });
  const bool turns = eachCubicKey(clip.rotations, key, [&](const auto&, const auto& keys, std::size_t at) {
    slope.rotation = outOf(keys, at).coeffs().template cast<double>();
    if (keys.values[at].w() < 0) slope.rotation *= -1;
    addKind(kindOf(keys.tangents[at]));
  });
  return moves || turns ? std::optional(slope) : std::nullopt;
}

void setSlope(Clip& clip, const JointKey& key, const KeySlope& slope, const Quat& rotation) {
  const bool moves = eachCubicKey(clip.translations, key, [&](auto& track, auto& keys, std::size_t at) {
    keys.tangents[at] = tangentsOf<Vec3f>(slope.tangents, slope.translation.cast<float>());
    putKeys(track, std::move(keys), Interpolation::kCubic);
  });
  const bool turns = eachCubicKey(clip.rotations, key, [&](auto& track, auto& keys, std::size_t at) {
    const bool other = keys.values[at].template cast<double>().dot(rotation) < 0;
    const Rotation along(Eigen::Vector4f((other ? -slope.rotation : slope.rotation).template cast<float>()));
    keys.tangents[at] = tangentsOf(slope.tangents, along);
    putKeys(track, std::move(keys), Interpolation::kCubic);
  });
  if (!moves && !turns) {
    throw Error(ErrorCode::kBadArgument, fmt::format("joint {} has no cubic key at {} s", key.joint, key.seconds));
  }
}

std::vector<JointKeyTimes> keyTimesOfJoints(const Clip& clip) {
  std::map<Index, std::vector<double>> ofJoint;
  forEachTrack(clip, [&](const auto& track) {
    std::vector<double>& times = ofJoint[track.joint];
    times.insert(times.end(), track.times.begin(), track.times.end());
  });
  std::vector<JointKeyTimes> list;
  for (auto& [joint, times] : ofJoint) list.push_back({joint, eachOnce(std::move(times))});
  return list;
}

bool isChosen(std::span<const JointKey> keys, Index joint, double seconds) {
  return std::any_of(keys.begin(), keys.end(), [&](const JointKey& key) {
    return key.joint == joint && std::abs(key.seconds - seconds) < kKeySnap;
  });
}

void requireKeys(const std::vector<JointKeyTimes>& there, std::span<const JointKey> keys) {
  for (const JointKey& key : keys) {
    const bool known = std::any_of(there.begin(), there.end(), [&](const JointKeyTimes& of) {
      return of.joint == key.joint && std::any_of(of.seconds.begin(), of.seconds.end(), [&](double seconds) {
               return std::abs(seconds - key.seconds) < kKeySnap;
             });
    });
    if (!known) {
      throw Error(ErrorCode::kBadArgument, fmt::format("joint {} has no key at {} s", key.joint, key.seconds));
    }
  }
}

void checkRetiming(std::span<const JointKey> keys, const KeyRetiming& retiming) {
  if (!(retiming.scale > 0) || !std::isfinite(retiming.scale) || !std::isfinite(retiming.pivot) ||
      !std::isfinite(retiming.shift)) {
    throw Error(ErrorCode::kBadArgument, "keys cannot be scaled in time by that");
  }
  for (const JointKey& key : keys) {
    if (!(retiming.at(key.seconds) > -kKeySnap)) {
      throw KnownError(
          ErrorKind::kKeyBeforeClip,
          {ErrorCode::kBadArgument, fmt::format("the key at {} s would come before the clip begins", key.seconds)},
          {{"seconds", fmt::format("{:.2f}", key.seconds)}});
    }
  }
}

void retimeKeys(Clip& clip, std::span<const JointKey> keys, const KeyRetiming& retiming) {
  requireKeys(keyTimesOfJoints(clip), keys);
  checkRetiming(keys, retiming);
  forEachKind(clip, [&](auto& tracks) {
    for (auto& track : tracks) {
      auto [times, values, tangents] = keysOf(track);
      using Value = typename decltype(values)::value_type;
      struct Key {
        double seconds;
        Value value;
        std::optional<Tangents<Value>> tangents;

        void retimed(double scale) {
          const float by = static_cast<float>(1 / scale);
          if (tangents) tangents = {scaled(tangents->in, by), scaled(tangents->out, by)};
        }
      };
      std::vector<Key> timed;
      for (std::size_t k = 0; k < times.size(); ++k) timed.push_back({times[k], values[k], tangents[k]});
      const auto chosen = [&](double seconds) { return isChosen(keys, track.joint, seconds); };
      if (!retime(timed, chosen, retiming)) continue;
      Keys<Value> moved;
      for (const Key& key : timed) {
        moved.times.push_back(static_cast<float>(std::max(0.0, key.seconds)));
        moved.values.push_back(key.value);
        moved.tangents.push_back(key.tangents);
      }
      putKeys(track, std::move(moved), track.interpolation);
    }
  });
}

void deleteKeys(Clip& clip, std::span<const JointKey> keys) {
  requireKeys(keyTimesOfJoints(clip), keys);
  forEachKind(clip, [&](auto& tracks) {
    for (auto& track : tracks) {
      auto kept = keysOf(track);
      for (std::size_t k = kept.times.size(); k-- > 0;) {
        if (isChosen(keys, track.joint, kept.times[k])) eraseKey(kept, k);
      }
      if (kept.times.size() != track.times.size()) putKeys(track, std::move(kept), track.interpolation);
    }
    std::erase_if(tracks, [](const auto& track) { return track.times.empty(); });
  });
}

}  // namespace limber
