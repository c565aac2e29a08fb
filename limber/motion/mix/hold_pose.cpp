#include "limber/motion/mix/hold_pose.h"

#include <algorithm>
#include <cmath>

#include "limber/core/error.h"
#include "limber/motion/mix/pose_curve.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/skeleton/clip/tracks.h"

namespace limber {

namespace {

// Metres, and components of quaternions; 1e-5 to 1e-3; what retargeting leaves of frames that are alike; rounding only.
constexpr double kStill = 1e-4;

template <class Value>
bool isStill(const Track<Value>& track) {
  return track.times.size() == 1 || std::all_of(track.values.begin(), track.values.end(), [&](const Value& value) {
           return (coefficientsOf(value) - coefficientsOf(track.values.front())).cwiseAbs().maxCoeff() <= kStill;
         });
}

}  // namespace

bool isStill(const Clip& clip) {
  bool still = true;
  forEachTrack(clip, [&](const auto& track) { still = still && isStill(track); });
  return still;
}

ClipWithContacts holdPose(const Skeleton& skeleton, const Clip& clip, double seconds, double frameSeconds) {
  const double frames = std::ceil(seconds / frameSeconds - kWholeFrame) + 1;
  if (!(frames <= kMaxClipFrames)) {
    throw Error(ErrorCode::kLimit, "a pose would be held for too many frames", clip.name, "choose a shorter time");
  }
  Pose pose = restPose(skeleton);
  sampleClip(clip, 0, pose);
  const PoseSequence result{std::vector<Pose>(static_cast<std::size_t>(frames), pose), frameSeconds};
  return {clipOf(skeleton, result, clip.name), {}};
}

}  // namespace limber
