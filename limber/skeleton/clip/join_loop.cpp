#include "limber/skeleton/clip/join_loop.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "limber/core/error.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/clip/moving_roots.h"
#include "limber/skeleton/clip/tracks.h"
#include "limber/skeleton/motion.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

constexpr double kLongestFade = 0.2;     // seconds, of a difference in speed
constexpr double kFadePart = 1.0 / 3;    // of the clip, likewise at most
constexpr double kStraightAhead = 1e-6;  // radians: less of a turn is none

// How the body travels in one cycle: over the ground along a circle, or straight.
class Travel {
 public:
  Travel(const Affine& from, const Affine& to, bool turns) {
    const Quat since(decompose(to).rotation * decompose(from).rotation.inverse());
    if (turns) turn_ = std::remainder(2 * std::atan2(since.y(), since.w()), 2 * std::numbers::pi);
    const Vec3 offset = to.translation() - Eigen::AngleAxisd(turn_, Vec3::UnitY()) * from.translation();
    // A turn about +Y takes z + ix to e^(i angle) of it.
    offset_ = {offset.z(), offset.x()};
  }

  // The part u of a cycle. All of these are powers of one motion, so that speeds go on from cycle to cycle.
  Affine part(double u) const {
    const std::complex<double> i(0, 1);
    const std::complex<double> moved = std::abs(turn_) < kStraightAhead
                                           ? u * offset_
                                           : offset_ * (std::exp(i * turn_ * u) - 1.0) / (std::exp(i * turn_) - 1.0);
    Affine result = Affine::Identity();
    result.linear() = Eigen::AngleAxisd(turn_ * u, Vec3::UnitY()).toRotationMatrix();
    result.translation() = Vec3(moved.imag(), 0, moved.real());
    return result;
  }

 private:
  double turn_ = 0;
  std::complex<double> offset_;
};

Vec3 rotationVector(const Quat& to, const Quat& from) {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const Eigen::AngleAxisd angle(turn);
  return angle.angle() * angle.axis();
}

Quat rotationBy(const Vec3& vector) {
  const double angle = vector.norm();
  return angle > 0 ? Quat(Eigen::AngleAxisd(angle, vector / angle)) : Quat::Identity();
}

// By what a Transform differs from another: translation, rotation vector, scale.
using Offset = Eigen::Matrix<double, 9, 1>;

Offset offsetTo(const Transform& to, const Transform& from) {
  Offset offset;
  offset << to.translation - from.translation, rotationVector(to.rotation, from.rotation), to.scale - from.scale;
  return offset;
}

Transform movedBy(const Offset& offset, Transform value) {
  value.translation += offset.head<3>();
  value.rotation = (rotationBy(offset.segment<3>(3)) * value.rotation).normalized();
  value.scale += offset.tail<3>();
  return value;
}

// The difference to add to each value of what is to be a cycle.
template <typename Difference>
class Seam {
 public:
  // between(f, g): by what frame f, of frames 0 to `last` in even steps, differs from frame g.
  template <typename Between>
  Seam(std::size_t last, double duration, const Between& between)
      : duration_(duration), fade_(std::min(kLongestFade, duration * kFadePart)), gap_(between(last, 0)) {
    // Speeds at the ends, of second order, where there are frames for it.
    const double step = duration / static_cast<double>(last);
    const std::size_t k = std::min<std::size_t>(2, last / 2);
    const auto speed = [&](std::size_t one, std::size_t two, std::size_t end, double sign) {
      Difference result = Difference::Zero();
      result += sign * (k == 2 ? 2.0 : 1.0) / step * between(one, end);
      if (k == 2) result += sign * -0.5 / step * between(two, end);
      return result;
    };
    speedGap_ = speed(last - 1, last - k, last, -1);
    speedGap_ -= speed(1, k, 0, 1);
  }

  Difference at(double seconds) const {
    const double u = seconds / duration_, rest = duration_ - seconds;
    Difference result = Difference::Zero();
    result += (0.5 - u * u * (3 - 2 * u)) * gap_;
    const auto bump = [&](double t) { return t < fade_ ? t * (1 - t / fade_) * (1 - t / fade_) : 0; };
    result += 0.5 * (bump(seconds) + bump(rest)) * speedGap_;
    return result;
  }

 private:
  double duration_, fade_;
  Difference gap_, speedGap_;
};

double farthestJoint(const Skeleton& skeleton, const Pose& a, const Pose& b) {
  const std::vector<Vec3> one = posePositions(skeleton, a), other = posePositions(skeleton, b);
  double result = 0;
  for (std::size_t j = 0; j < one.size(); ++j) result = std::max(result, (one[j] - other[j]).norm());
  return result;
}

class Carriers {
 public:
  Carriers(const Skeleton& skeleton, const Clip& clip, Index body) : all_(movingRoots(skeleton, clip)) {
    const auto turns = [&](Index joint) {
      return std::any_of(clip.rotations.begin(), clip.rotations.end(),
                         [&](const auto& track) { return track.joint == joint && track.times.size() > 1; });
    };
    for (std::optional<Index> j = body; j && !turns_; j = skeleton.joints[*j].parent) {
      turns_ = turns(*j) && std::any_of(all_.begin(), all_.end(), [&](const auto& root) { return root.joint == *j; });
    }
  }

  bool turnTheBody() const { return turns_; }
  void move(const Affine& by, Pose& pose) const {
    for (const MovingRoot& root : all_) {
      Transform& local = pose.locals[root.joint];
      local = decompose(root.above.inverse(Eigen::Affine) * by * root.above * local.toAffine());
    }
  }

 private:
  std::vector<MovingRoot> all_;
  bool turns_ = false;
};

// Speeds at the ends are measured by even steps. The clip has a duration.
Clip inEvenSteps(const Clip& clip) {
  const double duration = clip.duration(), steps = std::max(2.0, std::round(duration * denseFrameRateOf(clip)));
  return resampleClip(clip, steps / duration);
}

}  // namespace

JoinedLoop joinLoop(const Skeleton& skeleton, const Clip& clip, Index body) {
  if (body >= skeleton.jointCount()) throw Error(ErrorCode::kBadArgument, "the body is no joint of the skeleton");
  JoinedLoop result;
  result.clip = clip;
  const double duration = clip.duration();
  if (duration <= 0 || longestTimes(clip).size() < 3) return result;
  Clip frames = inEvenSteps(clip);
  const std::vector<float> times = longestTimes(frames);
  if (times.size() < 3) return result;

  std::vector<Pose> poses(times.size(), restPose(skeleton));
  for (std::size_t k = 0; k < times.size(); ++k) sampleClip(clip, times[k], poses[k]);
  const std::vector<Pose> before = poses;
  const Carriers carriers(skeleton, frames, body);
  const Travel travel(poseGlobals(skeleton, poses.front())[body], poseGlobals(skeleton, poses.back())[body],
                      carriers.turnTheBody());
  const auto partAt = [&](std::size_t k) { return travel.part(times[k] / duration); };
  for (std::size_t k = 0; k < times.size(); ++k) carriers.move(partAt(k).inverse(Eigen::Isometry), poses[k]);
  result.gap = farthestJoint(skeleton, poses.back(), poses.front());
  Box box;
  for (const Vec3& position : restPositions(skeleton)) box.add(position);
  if (result.gap <= kClosedLoop * box.diagonal()) return result;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Seam<Offset> seam(times.size() - 1, duration, [&](std::size_t f, std::size_t g) {
      return offsetTo(poses[f].locals[j], poses[g].locals[j]);
    });
    for (std::size_t k = 0; k < times.size(); ++k) {
      poses[k].locals[j] = movedBy(seam.at(times[k]), poses[k].locals[j]);
    }
  }
  poses.back() = poses.front();
  for (std::size_t k = 0; k < times.size(); ++k) {
    carriers.move(partAt(k), poses[k]);
    result.largestChange = std::max(result.largestChange, farthestJoint(skeleton, poses[k], before[k]));
  }
  // Tracks that are of one key stand still, ends included.
  const auto write = [&](auto& tracks, auto&& value) {
    for (auto& track : tracks) {
      if (track.times.size() == 1) continue;
      for (std::size_t k = 0; k < times.size(); ++k) track.values[k] = value(poses[k].locals[track.joint]);
    }
  };
  write(frames.translations, [](const Transform& local) { return Vec3f(local.translation.cast<float>()); });
  write(frames.rotations, [](const Transform& local) { return Eigen::Quaternionf(local.rotation.cast<float>()); });
  write(frames.scales, [](const Transform& local) { return Vec3f(local.scale.cast<float>()); });
  for (auto& track : frames.rotations) keepNearSide(track.values);
  result.clip = std::move(frames);
  return result;
}

Track<Vec3f> joinTrack(const Track<Vec3f>& track) {
  Clip clip;
  clip.translations = {track};
  const double duration = clip.duration();
  if (duration <= 0 || track.times.size() < 2 || track.interpolation == Interpolation::kStep) return track;
  Track<Vec3f> frames = std::move(inEvenSteps(clip).translations.front());
  std::vector<Vec3f>& values = frames.values;
  if (values.size() < 3) return track;
  Vec3f least = values.front(), most = least;
  for (const Vec3f& value : values) {
    least = least.cwiseMin(value);
    most = most.cwiseMax(value);
  }
  const Seam<Vec3> seam(values.size() - 1, duration,
                        [&](std::size_t f, std::size_t g) { return Vec3((values[f] - values[g]).cast<double>()); });
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Vec3 joined = values[k].cast<double>() + seam.at(frames.times[k]);
    values[k] = joined.cast<float>().cwiseMax(least).cwiseMin(most);
  }
  values.back() = values.front();
  return frames;
}

}  // namespace limber
