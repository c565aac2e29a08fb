#include "limber/motion_mix/crossfade_motions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/error.h"
#include "limber/motion_mix/plant_mixed_feet.h"
#include "limber/motion_mix/transition.h"

namespace limber {

namespace {

constexpr double kAround = 1;  // seconds before the transition, and after feet have lifted off: they change there
constexpr double kLastMoment = 1e-9;  // seconds

// The first motion alone, both, the second alone.
std::vector<MixMoment> allMoments(const Transition& transition, double bDuration, double frameSeconds) {
  std::vector<MixMoment> moments;
  const double begin = *transition.moments.front().a, end = *transition.moments.back().b;
  const double before = std::round(begin / frameSeconds);
  for (double f = 0; f < before; ++f) moments.push_back({f * frameSeconds, std::nullopt, 0});
  moments.insert(moments.end(), transition.moments.begin(), transition.moments.end());
  for (double f = 1; end + f * frameSeconds <= bDuration + kLastMoment; ++f) {
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

}  // namespace

ClipWithContacts crossfadeMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                                  const CrossfadeOptions& options) {
  const ClipWithContacts both[] = {a, b};
  return joinMotions(skeleton, both, options).motion;
}

JoinedMotions joinMotions(const Skeleton& skeleton, std::span<const ClipWithContacts> motions,
                          const CrossfadeOptions& options) {
  if (motions.empty()) throw Error(ErrorCode::kBadArgument, "no motions to join");
  const MixBody body(skeleton);
  JoinedMotions joined = {motions.front(), {{0, motions.front().clip.duration()}}};
  for (const ClipWithContacts& next : motions.subspan(1)) {
    const MixMotion a(body, joined.motion), b(body, next);
    const double frameSeconds =
        options.frameRate ? 1 / *options.frameRate : std::min(a.frameSeconds(), b.frameSeconds());
    const Transition transition = findTransition(body, a, b, {options.seconds, frameSeconds, joined.spans.back().from});
    const std::vector<MixMoment> moments = allMoments(transition, b.duration(), frameSeconds);
    MixedFrames mixed = mixFrames(body, a, b, transition.phases, moments, frameSeconds);
    const auto begin = static_cast<std::size_t>(std::round(*transition.moments.front().a / frameSeconds));
    plantMixedFeet(body, rangeOf(mixed, begin, begin + transition.moments.size(), body.legs().size()), mixed);
    joined.motion = {clipOf(skeleton, body.plain().original(mixed.frames), motions.front().clip.name),
                     mixed.plantedFeet(body)};
    const auto lasts = static_cast<double>(transition.moments.size() - 1) * frameSeconds;
    const double from = static_cast<double>(begin) * frameSeconds;
    joined.spans.back().to = from + lasts;
    joined.spans.push_back({from, joined.motion.clip.duration()});
  }
  return joined;
}

}  // namespace limber
