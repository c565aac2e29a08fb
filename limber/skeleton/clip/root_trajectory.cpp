#include "limber/skeleton/clip/root_trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limber/core/error.h"
#include "limber/skeleton/clip/keys/keyframes.h"
#include "limber/skeleton/clip/tracks.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr double kSampleRate = 60, kMaxSamples = 1e6;  // of the path that is smoothed
constexpr double kMinRate = 30;                        // keys a second of the trajectory
constexpr double kDeviations = 3;                      // where the Gaussian ends
constexpr double kMinTwist = 0.05;  // of 1: the part of a rotation about +Y, below which it has no heading

// Rotation about +Y nearest to `turn`; nullopt where all are about as near.
std::optional<double> twist(const Quat& turn) {
  if (std::hypot(turn.y(), turn.w()) < kMinTwist) return std::nullopt;
  return 2 * std::atan2(turn.y(), turn.w());
}

// The angle plus whole turns that is nearest to the one before.
double unwrapped(double angle, double before) {
  return angle + 2 * std::numbers::pi * std::round((before - angle) / (2 * std::numbers::pi));
}

// Where the body is at one moment: x, y, z and heading.
using RootState = Eigen::Vector4d;

class BodyPath {
 public:
  BodyPath(const Skeleton& skeleton, const Clip& clip, Index body) : clip_(clip), pose_(restPose(skeleton)) {
    for (std::optional<Index> j = body; j; j = skeleton.joints[*j].parent) chain_.push_back(*j);
    rest_ = global();
  }

  const Affine& rest() const { return rest_; }
  bool has(Index joint) const { return std::find(chain_.begin(), chain_.end(), joint) != chain_.end(); }

  // Calls go on in time, for the heading's sake.
  RootState at(double seconds) {
    sampleClip(clip_, seconds, pose_);
    const Affine now = global();
    const Quat since(decompose(now).rotation * decompose(rest_).rotation.inverse());
    heading_ = unwrapped(twist(since).value_or(heading_), heading_);
    RootState state;
    state << now.translation(), heading_;
    return state;
  }

 private:
  Affine global() const {
    Affine result = Affine::Identity();
    for (const Index joint : chain_) result = pose_.locals[joint].toAffine() * result;
    return result;
  }

  const Clip& clip_;
  Pose pose_;
  std::vector<Index> chain_;  // from the body up
  Affine rest_;
  double heading_ = 0;
};

std::vector<float> trajectoryTimes(const Clip& clip, const BodyPath& path) {
  std::vector<double> keys = {0, clip.duration()};
  forEachTrack(clip, [&](const auto& track) {
    if (!path.has(track.joint) || track.times.size() < 2) return;
    keys.insert(keys.end(), track.times.begin(), track.times.end());
  });
  const double frame = 1 / std::max(frameRateOf(clip), kMinRate);
  std::vector<float> times;
  for (const double key : eachOnce(std::move(keys))) {
    if (!times.empty()) {
      const double before = times.back();
      const double steps = std::min(std::round((key - before) / frame), kMaxSamples);
      for (double k = 1; k < steps; ++k) times.push_back(static_cast<float>(before + (key - before) * k / steps));
    }
    times.push_back(static_cast<float>(key));
  }
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

// Evenly sampled positions, and those beyond their ends.
class SampledPath {
 public:
  SampledPath(BodyPath& path, double duration, bool loops) : loops_(loops) {
    count_ = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(duration * kSampleRate), 1.0, kMaxSamples));
    step_ = duration / static_cast<double>(count_);
    for (std::ptrdiff_t i = 0; i <= count_; ++i) states_.push_back(path.at(step_ * static_cast<double>(i)));
    // Cycle after cycle the stride goes where the body has turned to.
    turn_ = states_.back().w() - states_.front().w();
    const Quat turn(Eigen::AngleAxisd(turn_, Vec3::UnitY()));
    stride_ = states_.back().head<3>() - turn * states_.front().head<3>();
  }

  void smooth(double deviation) {
    const auto reach = static_cast<std::ptrdiff_t>(step_ > 0 ? std::ceil(kDeviations * deviation / step_) : 0);
    std::vector<double> kernel;
    double sum = 0;
    for (std::ptrdiff_t k = -reach; k <= reach; ++k) {
      const double x = static_cast<double>(k) * step_ / deviation;
      kernel.push_back(reach > 0 ? std::exp(-0.5 * x * x) : 1);
      sum += kernel.back();
    }
    std::vector<RootState> result;
    for (std::ptrdiff_t i = 0; i <= count_; ++i) {
      RootState state = RootState::Zero();
      for (std::ptrdiff_t k = -reach; k <= reach; ++k) state += kernel[k + reach] / sum * beyond(i + k);
      result.push_back(state);
    }
    states_ = std::move(result);
  }

  RootState at(double seconds) const {
    const double state = step_ > 0 ? std::clamp(seconds / step_, 0.0, static_cast<double>(count_)) : 0;
    const auto before = std::min(static_cast<std::ptrdiff_t>(state), count_ - 1);
    const double u = state - static_cast<double>(before);
    return (1 - u) * states_[before] + u * states_[before + 1];
  }

 private:
  RootState beyond(std::ptrdiff_t i) const {
    if (i >= 0 && i <= count_) return states_[i];
    if (!loops_) {
      const RootState& end = i < 0 ? states_.front() : states_.back();
      const std::ptrdiff_t mirrored = std::clamp<std::ptrdiff_t>(i < 0 ? -i : 2 * count_ - i, 0, count_);
      return 2 * end - states_[mirrored];
    }
    const std::ptrdiff_t cycles = i >= 0 ? i / count_ : -((-i + count_ - 1) / count_);
    RootState state = states_[i - cycles * count_];
    const Quat turn(Eigen::AngleAxisd(cycles > 0 ? turn_ : -turn_, Vec3::UnitY()));
    for (std::ptrdiff_t c = 0; c < std::abs(cycles); ++c) {
      const Vec3 p = state.head<3>();
      state.head<3>() = cycles > 0 ? Vec3(turn * p + stride_) : Vec3(turn * (p - stride_));
      state.w() += cycles > 0 ? turn_ : -turn_;
    }
    return state;
  }

  bool loops_;
  std::ptrdiff_t count_ = 1;
  double step_ = 0, turn_ = 0;
  Vec3 stride_ = Vec3::Zero();
  std::vector<RootState> states_;
};

}  // namespace

Transform RootTrajectory::at(double seconds) const {
  const auto next =
      std::upper_bound(times.begin(), times.end(), seconds, [](double time, float key) { return time < key; });
  const auto after = static_cast<std::size_t>(next - times.begin());
  const std::size_t a = after == 0 ? 0 : after - 1, b = std::min(after, times.size() - 1);
  const double u = a == b ? 0 : (seconds - times[a]) / (double{times[b]} - times[a]);
  Transform result;
  result.translation = (1 - u) * offsets[a] + u * offsets[b];
  if (!headings.empty()) {
    result.rotation = Eigen::AngleAxisd((1 - u) * headings[a] + u * headings[b], Vec3::UnitY());
  }
  return result;
}

RootTrajectory rootTrajectory(const Skeleton& skeleton, const Clip& clip, const RootMotionOptions& options) {
  if (options.body >= skeleton.jointCount())
    throw Error(ErrorCode::kBadArgument, "the body is no joint of the skeleton");
  if (!(options.smoothing >= 0) || !std::isfinite(options.smoothing)) {
    throw Error(ErrorCode::kBadArgument, "the smoothing of a trajectory must be a time, at least 0");
  }
  BodyPath path(skeleton, clip, options.body);
  RootTrajectory result;
  result.times = trajectoryTimes(clip, path);
  std::vector<RootState> states;
  if (options.smoothing > 0) {
    SampledPath sampled(path, clip.duration(), options.loops);
    sampled.smooth(options.smoothing);
    for (const float time : result.times) states.push_back(sampled.at(time));
  } else {
    for (const float time : result.times) states.push_back(path.at(time));
  }
  const Vec3 rest = path.rest().translation();
  for (const RootState& state : states) {
    const double heading = options.heading ? state.w() : 0;
    Vec3 offset = state.head<3>() - Eigen::AngleAxisd(heading, Vec3::UnitY()) * rest;
    if (!options.height) offset.y() = 0;
    result.offsets.push_back(offset);
    if (options.heading) result.headings.push_back(heading);
  }
  return result;
}

}  // namespace limber
