#include "limber/skeleton/clip_player.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

using Float4 = float __attribute__((vector_size(16)));

constexpr double kLongestTurn = 0.05;  // radians between two cached rotations
constexpr double kNever = std::numeric_limits<double>::infinity();

// Four joints side by side: what they are at the beginning of a short interval, and how they change in it.
struct Group {
  Float4 translation[3] = {}, translationRate[3] = {};
  Float4 rotation[4] = {}, rotationRate[4] = {};  // x, y, z, w
  Float4 scale[3] = {}, scaleRate[3] = {};
  double begin = 0, end = -kNever;  // seconds; valid from begin up to, not including, end
};

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
  Clip clip;
  Pose from, to;                                          // at the ends of the interval that is being cached
  std::vector<Index> parents;                             // #J; kNoIndex for roots
  std::vector<const Track<Vec3f>*> translations, scales;  // #J, null without
  std::vector<const Track<Eigen::Quaternionf>*> rotations;
  std::vector<Group> groups;

  void cache(std::size_t group, double seconds);
  void sampleJoint(Index joint, double seconds, Pose& pose) const;
  void write(std::size_t group, float elapsed, std::span<Eigen::Matrix4f> globals) const;
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
  for (Index j = first; j < last; ++j) {
    sampleJoint(j, at, from);
    if (still) {
      to.locals[j] = from.locals[j];
      continue;
    }
    // Just before the end: steps have not happened yet.
    sampleJoint(j, std::nextafter(end, begin), to);
    turn = std::max(turn, from.locals[j].rotation.angularDistance(to.locals[j].rotation));
  }
  if (turn > kLongestTurn) {
    const double part = (end - begin) / std::ceil(turn / kLongestTurn), steps = std::floor((seconds - begin) / part);
    const double wholeEnd = end;
    begin = begin + steps * part;
    end = std::min(wholeEnd, begin + part);
    for (Index j = first; j < last; ++j) {
      sampleJoint(j, begin, from);
      sampleJoint(j, end < wholeEnd ? end : std::nextafter(end, begin), to);
    }
  }
  g.begin = still && !std::isfinite(begin) ? seconds : begin;
  g.end = end;
  const double rate = still || !(end > begin) ? 0 : 1 / (end - begin);
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

void ClipPlayer::Packed::write(std::size_t group, float elapsed, std::span<Eigen::Matrix4f> globals) const {
  const Group& g = groups[group];
  Float4 q[4], t[3], s[3];
  for (int k = 0; k < 4; ++k) q[k] = g.rotation[k] + elapsed * g.rotationRate[k];
  for (int k = 0; k < 3; ++k) t[k] = g.translation[k] + elapsed * g.translationRate[k];
  for (int k = 0; k < 3; ++k) s[k] = g.scale[k] + elapsed * g.scaleRate[k];
  // 2 / |q|^2 by its series: turns are so short that |q|^2 is 1 to within 1e-3.
  const Float4 excess = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1.0f;
  const Float4 two = 2.0f - 2.0f * excess + 2.0f * excess * excess;
  const Float4 x = two * q[0], y = two * q[1], z = two * q[2];
  const Float4 xx = x * q[0], yy = y * q[1], zz = z * q[2], xy = x * q[1], xz = x * q[2], yz = y * q[2];
  const Float4 xw = x * q[3], yw = y * q[3], zw = z * q[3];
  const Float4 m[4][3] = {{s[0] * (1.0f - yy - zz), s[0] * (xy + zw), s[0] * (xz - yw)},
                          {s[1] * (xy - zw), s[1] * (1.0f - xx - zz), s[1] * (yz + xw)},
                          {s[2] * (xz + yw), s[2] * (yz - xw), s[2] * (1.0f - xx - yy)},
                          {t[0], t[1], t[2]}};
  const std::size_t first = 4 * group, lanes = std::min<std::size_t>(4, parents.size() - first);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
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
    if (!(seconds >= p.groups[g].begin && seconds < p.groups[g].end)) p.cache(g, seconds);
    p.write(g, static_cast<float>(seconds - p.groups[g].begin), globals);
  }
}

}  // namespace limber
