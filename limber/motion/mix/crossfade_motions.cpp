#include "limber/motion/mix/crossfade_motions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/motion/mix/hold_pose.h"
#include "limber/motion/mix/plant_mixed_feet.h"
#include "limber/motion/mix/pose_curve.h"
#include "limber/motion/mix/transition.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

// Seconds; 0.3 to 2; before the transition, and after feet have lifted off: changes come and go there; set by hand.
constexpr double kAround = 1;

// The first motion alone, both, the second alone.
std::vector<MixMoment> allMoments(const Transition& transition, double bDuration, double frameSeconds) {
  std::vector<MixMoment> moments;
  const double begin = *transition.moments.front().a, end = *transition.moments.back().b;
  const double before = std::round(begin / frameSeconds);
  for (double f = 0; f < before; ++f) moments.push_back({f * frameSeconds, std::nullopt, 0});
  moments.insert(moments.end(), transition.moments.begin(), transition.moments.end());
  for (double f = 1; end + f * frameSeconds <= bDuration + kSameTime; ++f) {
    moments.push_back({std::nullopt, end + f * frameSeconds, 1});
  }
  return moments;
}

// From a while before the transition until each foot that was planted at its end has been lifted.
MixedRange rangeOf(const MixedFrames& mixed, std::size_t begin, std::size_t end, std::size_t legs) {
  const std::size_t frames = mixed.frames.poses.size();
  const auto around = static_cast<std::size_t>(std::round(kAround / mixed.frames.frameSeconds));
  std::size_t lifted = end;
  for (std::size_t leg = 0; leg < legs; ++leg) {
    std::size_t f = end;
    while (f < frames && mixed.feet[f * legs + leg].planted) ++f;
    lifted = std::max(lifted, f);
  }
  return {begin > around ? begin - around : 0, std::min(frames, lifted + around), false};
}

// One that is still lasts long enough for the transitions at its sides, at the rate of the one beside it.
ClipWithContacts extendForTransitions(const Skeleton& skeleton, std::span<const ClipWithContacts> motions,
                                      std::size_t i, const CrossfadeOptions& options) {
  const Clip& clip = motions[i].clip;
  const double needed = (i == 0 || i + 1 == motions.size() ? 1 : 2) * options.seconds;
  if (motions.size() == 1 || clip.duration() >= needed || !isStill(clip)) return motions[i];
  const double rate = options.frameRate.value_or(denseFrameRateOf(motions[i == 0 ? 1 : i - 1].clip));
  return holdPose(skeleton, clip, needed, 1 / rate);
}

void warnOfLength(double asked, double taken, const Clip& a, const Clip& b, Warnings& warnings) {
  warnings.add("short-transitions",
               fmt::format("a motion is too short for a transition of {:.3g} s, which takes {:.3g} s", asked, taken),
               fmt::format("{}, {}", a.name, b.name));
}

}  // namespace

ClipWithContacts crossfadeMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                                  const CrossfadeOptions& options, Warnings* warnings) {
  const ClipWithContacts both[] = {a, b};
  return joinMotions(skeleton, both, options, warnings).motion;
}

JoinedMotions joinMotions(const Skeleton& skeleton, std::span<const ClipWithContacts> motions,
                          const CrossfadeOptions& options, Warnings* warnings) {
  if (motions.empty()) throw Error(ErrorCode::kBadArgument, "no motions to join");
  const MixBody body(skeleton);
  JoinedMotions joined;
  joined.motion = extendForTransitions(skeleton, motions, 0, options);
  joined.spans = {{0, joined.motion.clip.duration()}};
  double most = options.seconds;  // that a transition takes: of a motion between two others half
  for (std::size_t i = 1; i < motions.size(); ++i) {
    // What is joined already begins as it should: the spans are those of its frames.
    const MixMotion a(body, joined.motion, i > 1), b(body, extendForTransitions(skeleton, motions, i, options));
    const double frameSeconds =
        options.frameRate ? 1 / *options.frameRate : std::min(a.frameSeconds(), b.frameSeconds());
    const double half = i + 1 < motions.size() ? std::max(frameSeconds, b.duration() / 2) : options.seconds;
    const Transition transition =
        findTransition(body, a, b, {std::min({options.seconds, most, half}), frameSeconds, joined.spans.back().from});
    most = half;
    const std::vector<MixMoment> moments = allMoments(transition, b.duration(), frameSeconds);
    MixedFrames mixed = mixFrames(body, a, b, transition.phases, moments, frameSeconds);
    const auto begin = static_cast<std::size_t>(std::round(*transition.moments.front().a / frameSeconds));
    plantMixedFeet(body, rangeOf(mixed, begin, begin + transition.moments.size(), body.legs().size()), mixed);
    joined.motion = {clipOf(skeleton, body.plain().original(mixed.frames), motions.front().clip.name),
                     mixed.plantedFeet(body)};
    const auto frames = static_cast<double>(transition.moments.size() - 1);
    const double lasts = frames * frameSeconds;
    if (warnings && frames + 1 <= options.seconds / frameSeconds + kWholeFrame) {
      warnOfLength(options.seconds, lasts, motions[i - 1].clip, motions[i].clip, *warnings);
    }
    const double from = static_cast<double>(begin) * frameSeconds;
    joined.spans.back().to = from + lasts;
    joined.spans.push_back({from, joined.motion.clip.duration()});
  }
  return joined;
}

}  // namespace limber
