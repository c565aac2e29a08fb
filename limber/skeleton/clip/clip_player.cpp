#include "limber/skeleton/clip/clip_player.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/float4.h"
#include "limber/core/sort_unique.h"
#include "limber/skeleton/clip/keys/key_rounding.h"

namespace limber {

namespace {

constexpr double kLongestTurn = 0.05;        // radians between two cached rotations
constexpr double kLongestPackedTurn = 0.25;  // radians between two packed ones
constexpr std::size_t kMaxKeys = 2;          // packed keys of four joints, against those of the longest of their tracks
constexpr double kNever = std::numeric_limits<double>::infinity();

// The interval round `seconds` in which a track changes evenly; all before its first and after its last key.
template <typename Value>
void narrow(const Track<Value>& track, double seconds, double& begin, double& end) {
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), seconds,
                                     [](double time, float key) { return time < key; });
  if (next != track.times.begin()) begin = std::max(begin, double{*(next - 1)});
  if (next != track.times.end()) end = std::min(end, double{*next});
}

template <typename Value>
bool isCurved(const Track<Value>& track) {
  return track.interpolation == Interpolation::kCubic;
}

}  // namespace

struct ClipPlayer::Packed {
  // Four joints side by side: what they are at the beginning of a short interval, and how they change in it.
  struct Group {
    Float4 translation[3] = {}, translationRate[3] = {};
    Float4 rotation[4] = {}, rotationRate[4] = {};  // x, y, z, w
    Float4 scale[3] = {}, scaleRate[3] = {};
    double begin = 0, end = -kNever;  // seconds; valid from begin up to, not including, end
  };

  // The transforms of four joints.
  struct Locals {
    Float4 translation[3], rotation[4], scale[3];  // rotation: x, y, z, w; of about unit length
  };

  // Four joints at all of their keys together, ready to be read: nothing is left to do where a key is passed. Kept for
  // joints whose tracks are linear and have most of their times in common, as those of recorded motion do.
  struct GroupKeys {
    std::vector<float> times, perSpan;  // #K seconds; #K - 1 inverses of the spans
    std::vector<Locals> values;         // #K; each rotation on the half sphere of the one before
    std::size_t at = 0;                 // the interval met last
  };

  Clip clip;
  Pose from, to;                                          // at the ends of the interval that is being cached
  std::vector<Index> parents;                             // #J; kNoIndex for roots
  std::vector<const Track<Vec3f>*> translations, scales;  // #J, null without
  std::vector<const Track<Eigen::Quaternionf>*> rotations;
  std::vector<Group> groups;
  std::vector<GroupKeys> keys;  // #groups; without times where a group is cached instead

  void pack(std::size_t group);
  std::vector<float> packedTimes(std::size_t group) const;
  void sampleGroup(std::size_t group, double seconds, Pose& pose) const;
  double largestTurn(std::size_t group) const;
  Locals packedLocals(std::size_t group, double seconds);
  Locals cachedLocals(std::size_t group, double seconds);
  void cache(std::size_t group, double seconds);
  void sampleJoint(Index joint, double seconds, Pose& pose) const;
  void write(std::size_t group, const Locals& locals, std::span<Eigen::Matrix4f> globals) const;
};

void ClipPlayer::Packed::sampleJoint(Index joint, double seconds, Pose& pose) const {
  Transform& local = pose.locals[joint];
  if (translations[joint]) local.translation = sampleTrack(*translations[joint], seconds);
  if (rotations[joint]) local.rotation = sampleTrack(*rotations[joint], seconds);
  if (scales[joint]) local.scale = sampleTrack(*scales[joint], seconds);
}

void ClipPlayer::Packed::cache(std::size_t group, double seconds) {
  Group& g = groups[group];
  const auto first = static_cast<Index>(4 * group), last = std::min(first + 4, static_cast<Index>(parents.size()));
  double begin = -kNever, end = kNever;
  bool curved = false;
  for (Index j = first; j < last; ++j) {
    if (translations[j]) narrow(*translations[j], seconds, begin, end), curved |= isCurved(*translations[j]);
    if (rotations[j]) narrow(*rotations[j], seconds, begin, end), curved |= isCurved(*rotations[j]);
    if (scales[j]) narrow(*scales[j], seconds, begin, end), curved |= isCurved(*scales[j]);
  }
  // Before the first key and after the last nothing changes. A curve is exact at the time asked for only.
  bool still = !std::isfinite(begin) || !std::isfinite(end);
  if (curved) begin = end = seconds;
  if (curved) still = true;
  const double at = still ? seconds : begin;
  double turn = 0;
  double changed = justBefore(end);  // where the change is measured: constant keys at the end do not count yet
  for (Index j = first; j < last; ++j) {
    sampleJoint(j, at, from);
    if (still) {
      to.locals[j] = from.locals[j];
      continue;
    }
    sampleJoint(j, changed, to);
    turn = std::max(turn, from.locals[j].rotation.angularDistance(to.locals[j].rotation));
  }
  if (turn > kLongestTurn) {
    const double part = (end - begin) / std::ceil(turn / kLongestTurn), steps = std::floor((seconds - begin) / part);
    const double wholeEnd = end;
    begin = begin + steps * part;
    end = std::min(wholeEnd, begin + part);
    if (end < wholeEnd) changed = end;
    for (Index j = first; j < last; ++j) {
      sampleJoint(j, begin, from);
      sampleJoint(j, changed, to);
    }
  }
  g.begin = still && !std::isfinite(begin) ? seconds : begin;
  g.end = end;
  const double rate = still || !(changed > begin) ? 0 : 1 / (changed - begin);
  for (Index j = first; j < last; ++j) {
    const std::size_t lane = j - first;
    const Transform &a = from.locals[j], &b = to.locals[j];
    const double sign = a.rotation.dot(b.rotation) < 0 ? -1 : 1;
    for (int k = 0; k < 4; ++k) {
      g.rotation[k][lane] = static_cast<float>(a.rotation.coeffs()[k]);
      g.rotationRate[k][lane] = static_cast<float>(rate * (sign * b.rotation.coeffs()[k] - a.rotation.coeffs()[k]));
    }
    for (int k = 0; k < 3; ++k) {
      g.translation[k][lane] = static_cast<float>(a.translation[k]);
      g.translationRate[k][lane] = static_cast<float>(rate * (b.translation[k] - a.translation[k]));
      g.scale[k][lane] = static_cast<float>(a.scale[k]);
      g.scaleRate[k][lane] = static_cast<float>(rate * (b.scale[k] - a.scale[k]));
    }
  }
}

ClipPlayer::Packed::Locals ClipPlayer::Packed::cachedLocals(std::size_t group, double seconds) {
  Group& g = groups[group];
  if (!(seconds >= g.begin && seconds < g.end)) cache(group, seconds);
  const auto elapsed = static_cast<float>(seconds - g.begin);
  Locals locals;
  for (int k = 0; k < 4; ++k) locals.rotation[k] = g.rotation[k] + elapsed * g.rotationRate[k];
  for (int k = 0; k < 3; ++k) locals.translation[k] = g.translation[k] + elapsed * g.translationRate[k];
  for (int k = 0; k < 3; ++k) locals.scale[k] = g.scale[k] + elapsed * g.scaleRate[k];
  return locals;
}

void ClipPlayer::Packed::sampleGroup(std::size_t group, double seconds, Pose& pose) const {
  const auto first = static_cast<Index>(4 * group), last = std::min(first + 4, static_cast<Index>(parents.size()));
  for (Index j = first; j < last; ++j) sampleJoint(j, seconds, pose);
}

// The largest rotation of the group's joints between `from` and `to`.
double ClipPlayer::Packed::largestTurn(std::size_t group) const {
  double turn = 0;
  for (std::size_t j = 4 * group; j < std::min(4 * group + 4, parents.size()); ++j) {
    turn = std::max(turn, from.locals[j].rotation.angularDistance(to.locals[j].rotation));
  }
  return turn;
}

// All times at which any of the group's tracks has a key; none where these are too many or a track is not linear.
std::vector<float> ClipPlayer::Packed::packedTimes(std::size_t group) const {
  std::vector<float> times;
  std::size_t most = 1;
  bool linear = true;
  const auto take = [&](const auto* track) {
    if (!track) return;
    linear = linear && (track->interpolation == Interpolation::kLinear || track->times.size() == 1);
    most = std::max(most, track->times.size());
    times.insert(times.end(), track->times.begin(), track->times.end());
  };
  for (std::size_t j = 4 * group; j < std::min(4 * group + 4, parents.size()); ++j) {
    take(translations[j]);
    take(rotations[j]);
    take(scales[j]);
  }
  sortUnique(times);
  if (times.empty()) times.push_back(0);
  return linear && times.size() <= kMaxKeys * most ? times : std::vector<float>();
}

// Fills the group's keys, with some between where a joint turns far, so that rotations stay even in time.
void ClipPlayer::Packed::pack(std::size_t group) {
  const std::vector<float> given = packedTimes(group);
  if (given.empty()) return;
  GroupKeys& k = keys[group];
  for (std::size_t i = 0; i < given.size(); ++i) {
    sampleGroup(group, given[i], from);
    sampleGroup(group, given[std::min(i + 1, given.size() - 1)], to);
    const double parts = std::max(1.0, std::ceil(largestTurn(group) / kLongestPackedTurn));
    for (double part = 0; part < parts && (part == 0 || i + 1 < given.size()); ++part) {
      const auto time = static_cast<float>(
          given[i] + part / parts * (double{given[std::min(i + 1, given.size() - 1)]} - double{given[i]}));
      if (k.times.empty() || time > k.times.back()) k.times.push_back(time);
    }
  }
  k.values.reserve(k.times.size());
  for (std::size_t i = 0; i < k.times.size(); ++i) {
    if (i > 0) k.perSpan.push_back(std::min(1 / (k.times[i] - k.times[i - 1]), std::numeric_limits<float>::max()));
    sampleGroup(group, k.times[i], from);
    Locals& values = k.values.emplace_back();
    for (std::size_t lane = 0; lane < 4; ++lane) {
      const Transform& local = from.locals[std::min(4 * group + lane, parents.size() - 1)];
      Vec4 before = Vec4::Zero();
      for (int c = 0; c < 4 && i > 0; ++c) before[c] = k.values[i - 1].rotation[c][lane];
      const double sign = local.rotation.coeffs().dot(before) < 0 ? -1 : 1;
      for (int c = 0; c < 4; ++c) values.rotation[c][lane] = static_cast<float>(sign * local.rotation.coeffs()[c]);
      for (int c = 0; c < 3; ++c) values.translation[c][lane] = static_cast<float>(local.translation[c]);
      for (int c = 0; c < 3; ++c) values.scale[c][lane] = static_cast<float>(local.scale[c]);
    }
  }
}

ClipPlayer::Packed::Locals ClipPlayer::Packed::packedLocals(std::size_t group, double seconds) {
  GroupKeys& k = keys[group];
  const std::size_t intervals = k.perSpan.size();
  if (intervals == 0) return k.values[0];
  const auto inside = [&](std::size_t i) { return seconds >= k.times[i] && seconds < k.times[i + 1]; };
  if (!inside(k.at) && (k.at + 1 == intervals || !inside(++k.at))) {
    const auto next = std::upper_bound(k.times.begin() + 1, k.times.end() - 1, seconds,
                                       [](double time, float key) { return time < key; });
    k.at = static_cast<std::size_t>(next - k.times.begin()) - 1;
  }
  const Locals &a = k.values[k.at], &b = k.values[k.at + 1];
  const float u = std::clamp(static_cast<float>(seconds - k.times[k.at]) * k.perSpan[k.at], 0.0f, 1.0f);
  Locals locals;
  // Rotation at constant speed, to the fraction u: sin(u w) / (sin(u w) + sin(w - u w)) of the chord to the next
  // rotation, w the angle between the two in four dimensions; to the third order in w, with
  // w^2 = 2 (1 - cos w) + (1 - cos w)^2 / 3.
  Float4 off = {1, 1, 1, 1};
  for (int c = 0; c < 4; ++c) off -= a.rotation[c] * b.rotation[c];
  const Float4 bend = (2.0f / 3 + off / 9.0f) * off;
  const Float4 along = u + bend * (u * (u - 0.5f) * (u - 1));
  for (int c = 0; c < 4; ++c) locals.rotation[c] = a.rotation[c] + along * (b.rotation[c] - a.rotation[c]);
  for (int c = 0; c < 3; ++c) locals.translation[c] = a.translation[c] + u * (b.translation[c] - a.translation[c]);
  for (int c = 0; c < 3; ++c) locals.scale[c] = a.scale[c] + u * (b.scale[c] - a.scale[c]);
  return locals;
}

void ClipPlayer::Packed::write(std::size_t group, const Locals& locals, std::span<Eigen::Matrix4f> globals) const {
  const Float4 *q = locals.rotation, *t = locals.translation, *s = locals.scale;
  const Float4 two = 2.0f / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const Float4 x = two * q[0], y = two * q[1], z = two * q[2];
  const Float4 xx = x * q[0], yy = y * q[1], zz = z * q[2], xy = x * q[1], xz = x * q[2], yz = y * q[2];
  const Float4 xw = x * q[3], yw = y * q[3], zw = z * q[3];
  const Float4 m[4][3] = {{s[0] * (1.0f - yy - zz), s[0] * (xy + zw), s[0] * (xz - yw)},
                          {s[1] * (xy - zw), s[1] * (1.0f - xx - zz), s[1] * (yz + xw)},
                          {s[2] * (xz + yw), s[2] * (yz - xw), s[2] * (1.0f - xx - yy)},
                          {t[0], t[1], t[2]}};
  const std::size_t first = 4 * group, lanes = std::min<std::size_t>(4, parents.size() - first);
#pragma GCC unroll 4  // with lanes known by number nothing goes through memory
  for (std::size_t lane = 0; lane < 4; ++lane) {
    if (lane == lanes) break;
    Float4 parent[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    if (parents[first + lane] != kNoIndex) std::memcpy(parent, globals[parents[first + lane]].data(), sizeof(parent));
    Float4 columns[4];
    for (int c = 0; c < 4; ++c) {
      columns[c] = parent[0] * m[c][0][lane] + parent[1] * m[c][1][lane] + parent[2] * m[c][2][lane];
    }
    columns[3] += parent[3];
    std::memcpy(globals[first + lane].data(), columns, sizeof(columns));
  }
}

ClipPlayer::ClipPlayer(const Clip& clip, const Skeleton& skeleton) : packed_(std::make_unique<Packed>()) {
  checkClip(clip, skeleton);
  Packed& p = *packed_;
  const Index count = skeleton.jointCount();
  p.clip = clip;
  p.from = p.to = restPose(skeleton);
  p.translations.resize(count);
  p.scales.resize(count);
  p.rotations.resize(count);
  for (const Joint& joint : skeleton.joints) p.parents.push_back(joint.parent.value_or(kNoIndex));
  for (const auto& track : p.clip.translations) p.translations[track.joint] = &track;
  for (const auto& track : p.clip.rotations) p.rotations[track.joint] = &track;
  for (const auto& track : p.clip.scales) p.scales[track.joint] = &track;
  p.groups.resize((count + 3) / 4);
  p.keys.resize(p.groups.size());
  for (std::size_t g = 0; g < p.groups.size(); ++g) p.pack(g);
}

ClipPlayer::~ClipPlayer() = default;
ClipPlayer::ClipPlayer(ClipPlayer&&) noexcept = default;
ClipPlayer& ClipPlayer::operator=(ClipPlayer&&) noexcept = default;

void ClipPlayer::sample(double seconds, std::span<Eigen::Matrix4f> globals) {
  Packed& p = *packed_;
  if (globals.size() != p.parents.size()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} matrices for {} joints", globals.size(), p.parents.size()));
  }
  for (std::size_t g = 0; g < p.groups.size(); ++g) {
    p.write(g, p.keys[g].times.empty() ? p.cachedLocals(g, seconds) : p.packedLocals(g, seconds), globals);
  }
}

}  // namespace limber
