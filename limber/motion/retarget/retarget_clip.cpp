#include "limber/motion/retarget/retarget_clip.h"

#include <algorithm>
#include <cmath>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/core/known_error.h"
#include "limber/motion/limbs/limb_goals.h"
#include "limber/motion/retarget/motion_smoothing.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

// Metres of a translation, and of a rotation's components; 1e-9 to 1e-5; joints that move less have no track; rounding
// only.
constexpr double kMoved = 1e-7;

Quat nearTo(const Quat& rotation, const Quat& before) {
  return rotation.dot(before) < 0 ? Quat(-rotation.coeffs()) : rotation;
}

bool keepsContacts(const RetargetMethod& method, const RetargetOptions& options) {
  return method.solvesLimbs && options.contacts;
}

// A clip that is ready to be retargeted.
class PreparedClip {
 public:
  PreparedClip(const Skeleton& source, const Clip& clip, const Skeleton& target, const SkeletonMap& map,
               const RetargetOptions& options, double frameRate)
      : name_(clip.name),
        source_(source),
        target_(target),
        frames_(source_.plain(sampleFrames(source, clip, frameRate > 0 ? frameRate : frameRateOf(clip)))),
        setup_(source_.skeleton(), target_.skeleton(), map, options, &frames_) {}
  // The setup points into it.
  PreparedClip(const PreparedClip&) = delete;
  PreparedClip& operator=(const PreparedClip&) = delete;

  Clip retargeted(const RetargetMethod& method, const Skeleton& target) const {
    return clipOf(target, target_.original(retargetFrames(method, setup_, frames_)), name_);
  }

  std::vector<FootSpans> plantedFeet() const {
    const RootPositioner root(setup_);
    const LimbGoals goals(setup_, root);
    if (!goals.active()) return {};
    const std::vector<WatchedFoot> watched = goals.watchedFeet();
    const ContactTrack track(setup_, watched, frames_);
    std::vector<FootSpans> feet;
    for (std::size_t i = 0; i < watched.size(); ++i) feet.push_back({watched[i].ankle, track.spans(i)});
    return feet;
  }

 private:
  std::string name_;
  PlainSkeleton source_, target_;
  PoseSequence frames_;
  RetargetSetup setup_;
};

}  // namespace

PoseSequence sampleFrames(const Skeleton& skeleton, const Clip& clip, double frameRate) {
  const double last = std::round(clip.duration() * frameRate);
  if (!(frameRate > 0) || !(last < kMaxClipFrames)) {
    throw KnownError(ErrorKind::kMotionTooLong,
                     {ErrorCode::kLimit, "the motion has too many frames", clip.name, "choose a lower frame rate"},
                     {{"name", clip.name}});
  }
  PoseSequence frames;
  frames.frameSeconds = 1 / frameRate;
  frames.poses.assign(static_cast<std::size_t>(last) + 1, restPose(skeleton));
  for (std::size_t f = 0; f < frames.poses.size(); ++f) {
    sampleClip(clip, static_cast<double>(f) / frameRate, frames.poses[f]);
  }
  return frames;
}

Clip clipOf(const Skeleton& skeleton, const PoseSequence& frames, std::string name) {
  Clip clip;
  clip.name = std::move(name);
  std::vector<float> times;
  for (std::size_t f = 0; f < frames.poses.size(); ++f) {
    times.push_back(static_cast<float>(static_cast<double>(f) * frames.frameSeconds));
  }
  if (times.empty()) return clip;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Transform& rest = skeleton.joints[j].rest;
    bool turns = false, moves = false;
    for (const Pose& pose : frames.poses) {
      turns = turns || 1 - std::abs(pose.locals[j].rotation.dot(rest.rotation)) > kMoved * kMoved;
      moves = moves || (pose.locals[j].translation - rest.translation).norm() > kMoved;
    }
    if (turns) {
      Track<Eigen::Quaternionf> track{j, Interpolation::kLinear, times, {}};
      Quat before = rest.rotation;
      for (const Pose& pose : frames.poses) {
        before = nearTo(pose.locals[j].rotation.normalized(), before);
        track.values.push_back(before.cast<float>());
      }
      clip.rotations.push_back(std::move(track));
    }
    if (moves) {
      Track<Vec3f> track{j, Interpolation::kLinear, times, {}};
      for (const Pose& pose : frames.poses) track.values.push_back(pose.locals[j].translation.cast<float>());
      clip.translations.push_back(std::move(track));
    }
  }
  // A still motion keeps its duration.
  if (clip.duration() < times.back() && skeleton.jointCount() > 0) {
    const Eigen::Quaternionf still = frames.poses.front().locals[0].rotation.normalized().cast<float>();
    clip.rotations.push_back({0, Interpolation::kLinear, times, std::vector(times.size(), still)});
  }
  return clip;
}

PoseSequence retargetFrames(const RetargetMethod& method, const RetargetSetup& setup, const PoseSequence& source) {
  PoseSequence target;
  target.frameSeconds = source.frameSeconds;
  target.poses.assign(source.poses.size(), restPose(*setup.target));
  const std::unique_ptr<FrameRetargeter> retargeter = method.make(setup);
  for (std::size_t f = 0; f < source.poses.size(); ++f) {
    retargeter->next(source.poses[f], f == 0 ? 0 : source.frameSeconds, target.poses[f]);
  }
  if (method.refine) method.refine(setup, source, target);
  if (keepsContacts(method, setup.options) && setup.options.smoothMotion) smoothMotion(setup, source, target);
  return target;
}

Clip retargetClip(const RetargetMethod& method, const Skeleton& source, const Clip& clip, const Skeleton& target,
                  const SkeletonMap& map, const RetargetOptions& options, double frameRate) {
  checkClip(clip, source);
  return PreparedClip(source, clip, target, map, options, frameRate).retargeted(method, target);
}

ClipWithContacts retargetClipWithContacts(const RetargetMethod& method, const Skeleton& source, const Clip& clip,
                                          const Skeleton& target, const SkeletonMap& map,
                                          const RetargetOptions& options, double frameRate) {
  checkClip(clip, source);
  const PreparedClip prepared(source, clip, target, map, options, frameRate);
  ClipWithContacts result = {prepared.retargeted(method, target), {}};
  if (keepsContacts(method, options)) result.feet = prepared.plantedFeet();
  return result;
}

}  // namespace limber
