#include "limber/document/bvh/bvh_frames.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/skeleton/clip/keep_duration.h"

namespace limber {

namespace {

// `q` times the rotation about one axis, by half the angle's cosine and sine.
void turn(Quat& q, int axis, double degrees) {
  const double half = degrees * (kPi / 360);
  const double c = std::cos(half), s = std::sin(half);
  const double x = q.x(), y = q.y(), z = q.z(), w = q.w();
  switch (axis) {
    case 0:
      q.coeffs() << x * c + w * s, y * c + z * s, z * c - y * s, w * c - x * s;
      break;
    case 1:
      q.coeffs() << x * c - z * s, y * c + w * s, z * c + x * s, w * c - y * s;
      break;
    default:
      q.coeffs() << x * c + y * s, y * c - x * s, z * c + w * s, w * c - z * s;
  }
}

bool has(const BvhJoint& joint, BvhQuantity quantity) {
  return std::any_of(joint.channels.begin(), joint.channels.end(),
                     [&](const BvhChannel& channel) { return channel.quantity == quantity; });
}

bool equal(const Vec3f& a, const Vec3f& b) {
  return a == b;
}

bool equal(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  return a.coeffs() == b.coeffs();
}

// A component without a channel is the offset's already.
void addOffset(const std::vector<BvhChannel>& channels, const Vec3& offset, std::vector<Vec3f>& positions) {
  for (int axis = 0; axis < 3; ++axis) {
    const bool moved = std::any_of(channels.begin(), channels.end(), [&](const BvhChannel& channel) {
      return channel.quantity == BvhQuantity::kPosition && channel.axis == axis;
    });
    if (!moved) continue;
    for (Vec3f& position : positions) position[axis] = static_cast<float>(position[axis] + offset[axis]);
  }
}

template <typename Value>
void addTrack(std::vector<Track<Value>>& tracks, Index joint, std::vector<Value>& values,
              const std::vector<float>& times) {
  Track<Value> track;
  track.joint = joint;
  const bool constant =
      std::all_of(values.begin(), values.end(), [&](const Value& value) { return equal(value, values.front()); });
  if (constant) values.resize(1);
  track.values.assign(values.begin(), values.end());  // to size, and the larger memory back at once
  std::vector<Value>().swap(values);
  track.times.assign(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(track.values.size()));
  tracks.push_back(std::move(track));
}

}  // namespace

BvhFrames::BvhFrames(std::span<const BvhJoint> joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const BvhJoint& joint = joints[j];
    if (joint.channels.empty()) continue;
    Tracks tracks;
    tracks.joint = static_cast<Index>(j);
    tracks.root = !joint.parent;
    tracks.offset = joint.offset;
    tracks.channels = joint.channels;
    tracks.positions = has(joint, BvhQuantity::kPosition);
    tracks.rotations = has(joint, BvhQuantity::kRotation);
    tracks.scales = has(joint, BvhQuantity::kScale);
    moving_.push_back(std::move(tracks));
  }
}

void BvhFrames::addRotation(Tracks& tracks, const Quat& rotation) {
  Eigen::Quaternionf value(rotation.cast<float>());
  // q and -q are the same rotation, but interpolation to them takes different paths.
  if (!tracks.rotationValues.empty() && tracks.rotationValues.back().coeffs().dot(value.coeffs()) < 0) {
    value.coeffs() = -value.coeffs();
  }
  tracks.rotationValues.push_back(value);
}

void BvhFrames::addFrame(std::span<const double> values) {
  const double* next = values.data();
  for (Tracks& tracks : moving_) {
    Vec3 position = tracks.offset, scale = Vec3::Ones();
    Quat rotation = Quat::Identity();
    for (const BvhChannel& channel : tracks.channels) {
      const double value = *next++;
      if (channel.quantity == BvhQuantity::kRotation) {
        turn(rotation, channel.axis, value);
      } else {
        (channel.quantity == BvhQuantity::kPosition ? position : scale)[channel.axis] = value;
      }
    }
    if (tracks.rotations) addRotation(tracks, rotation);
    if (tracks.scales) tracks.scaleValues.emplace_back(scale.cast<float>());
    if (!tracks.positions) continue;
    tracks.positionValues.emplace_back(position.cast<float>());
    if (tracks.root) continue;
    squaresOfAbsolute_ += (position - tracks.offset).squaredNorm();
    squaresOfRelative_ += position.squaredNorm();
  }
  ++count_;
}

Clip BvhFrames::takeClip(double framesPerSecond) {
  std::vector<float> times(count_);
  for (std::size_t k = 0; k < count_; ++k) times[k] = static_cast<float>(static_cast<double>(k) / framesPerSecond);
  const bool relative = positionsAreRelative();
  Clip clip;
  for (Tracks& tracks : moving_) {
    if (count_ == 0) break;
    if (tracks.positions) {
      if (relative && !tracks.root) addOffset(tracks.channels, tracks.offset, tracks.positionValues);
      addTrack(clip.translations, tracks.joint, tracks.positionValues, times);
    }
    if (tracks.rotations) addTrack(clip.rotations, tracks.joint, tracks.rotationValues, times);
    if (tracks.scales) addTrack(clip.scales, tracks.joint, tracks.scaleValues, times);
  }
  keepDuration(clip, times);
  count_ = 0;
  return clip;
}

}  // namespace limber
