#include "limber/motion/mix/blend_motions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/motion/mix/gait/joint_clock.h"
#include "limber/motion/mix/hold_pose.h"
#include "limber/motion/mix/mixed_frames.h"
#include "limber/motion/mix/plant_mixed_feet.h"

namespace limber {

namespace {

struct Blending {
  int maxRepeats = 64;      // repeats; 8 to 1000; of a motion that loops: bounds memory; set by hand
  double samePhase = 1e-6;  // footfalls; 1e-9 to 1e-3; rounding only
  // Ratio; 2 to 4; strides a second grow fourfold from a stroll (0.55) to a sprint (2.2): beyond that no two are gaits
  // of one body.
  double maxRateRatio = 4;
};
constexpr Blending kBlending;

// What the blend plays: both motions, repeated where they loop, on one scale.
struct Together {
  MixMotion a, b;
  StridePhases phases;
  double from = 0, to = 0;           // phase
  std::optional<GroundFrame> start;  // where it begins, if not where the motions are then
  bool loops = false;
};

StridePhases wholeOf(const MixMotion& a, const MixMotion& b) {
  return {GaitPhase::ofWhole(a.duration()), GaitPhase::ofWhole(b.duration()), 0, 1};
}

std::optional<StridePhases> stepsOf(const MixMotion& a, const MixMotion& b) {
  const std::vector<StridePhases> found = matchStrides(a.footfalls(), b.footfalls());
  return found.empty() ? std::nullopt : std::optional(found.front());
}

// From the second of several repetitions to the third: footfalls.
long cycleOf(const GaitPhase& phase, double duration) {
  return std::max(1L, std::lround(phase.at(2 * duration) - phase.at(duration)));
}

int repeatsFor(double steps, long cycle) {
  return static_cast<int>(std::min<double>(kBlending.maxRepeats, std::ceil(steps / static_cast<double>(cycle)) + 2));
}

Together overCommonSpan(MixMotion a, MixMotion b, StridePhases phases) {
  const double from = std::max(phases.a.at(0), phases.b.at(0));
  const double to = std::min(phases.a.at(a.duration()), phases.b.at(b.duration()));
  return {std::move(a), std::move(b), std::move(phases), from, to, std::nullopt, false};
}

// Both go on and on: the blend is as long as it takes both to be where they began.
std::optional<Together> overLoops(const MixMotion& a, const MixMotion& b, double weight) {
  const std::optional<StridePhases> three = stepsOf(a.repeated(3), b.repeated(3));
  if (!three) return std::nullopt;
  const long ofA = cycleOf(three->a, a.duration()), ofB = cycleOf(three->b, b.duration()), both = std::lcm(ofA, ofB);
  if (both / std::min(ofA, ofB) > kBlending.maxRepeats / 2) return std::nullopt;
  MixMotion manyA = a.repeated(static_cast<int>(both / ofA) + 3), manyB = b.repeated(static_cast<int>(both / ofB) + 3);
  std::optional<StridePhases> phases = stepsOf(manyA, manyB);
  if (!phases) return std::nullopt;
  const double from = std::max(phases->a.at(a.duration()), phases->b.at(b.duration()));
  const GroundFrame start = between(a.groundAt(std::fmod(phases->a.when(from), a.duration())),
                                    b.groundAt(std::fmod(phases->b.when(from), b.duration())), weight);
  return Together{
      std::move(manyA), std::move(manyB), std::move(*phases), from, from + static_cast<double>(both), start, true};
}

Together playedTogether(MixMotion a, MixMotion b, double weight) {
  std::optional<StridePhases> phases = stepsOf(a, b);
  const bool aLoops = a.loops(), bLoops = b.loops();
  if (aLoops && bLoops) {
    if (std::optional<Together> loops = overLoops(a, b, weight)) return std::move(*loops);
  } else if (aLoops || bLoops) {
    MixMotion& looping = aLoops ? a : b;
    const MixMotion three = looping.repeated(3);
    if (const auto long_ = aLoops ? stepsOf(three, b) : stepsOf(a, three)) {
      const GaitPhase &ofLoop = aLoops ? long_->a : long_->b, &ofOther = aLoops ? long_->b : long_->a;
      const double steps = ofOther.at((aLoops ? b : a).duration()) - ofOther.at(0);
      looping = looping.repeated(repeatsFor(steps, cycleOf(ofLoop, looping.duration())));
      phases = stepsOf(a, b);
    }
  }
  if (phases) {
    Together together = overCommonSpan(a, b, *phases);
    if (together.from < together.to) return together;
  }
  StridePhases whole = wholeOf(a, b);
  Together together = overCommonSpan(std::move(a), std::move(b), std::move(whole));
  together.loops = aLoops && bLoops;
  return together;
}

// How many times as fast the phase grows in the faster motion as in the slower one, on the whole; NaN of two poses.
double rateRatio(const Together& together) {
  const auto lasts = [&](const GaitPhase& phase) { return phase.when(together.to) - phase.when(together.from); };
  const double ofA = lasts(together.phases.a), ofB = lasts(together.phases.b);
  return std::max(ofA, ofB) / std::min(ofA, ofB);
}

void warnOfRates(const Together& together, double weight, Warnings& warnings) {
  const double ratio = rateRatio(together);
  if (!(ratio > kBlending.maxRateRatio) || weight == 0 || weight == 1) return;
  warnings.add("unlike-rates",
               fmt::format("steps of blended motions, or what they last where one has none, differ by a factor of "
                           "{:.3g}: the slower motion is played too fast",
                           ratio),
               fmt::format("{}, {}", together.a.name(), together.b.name()));
}

// A pose has no speed that could be blended.
void holdPoses(const MixBody& body, const Clip& a, const Clip& b, MixMotion& first, MixMotion& second) {
  const bool aStill = isStill(a), bStill = isStill(b);
  const auto holdLike = [&](const Clip& pose, const MixMotion& other) {
    return MixMotion(body, holdPose(body.original(), pose, other.duration(), other.frameSeconds()));
  };
  if (aStill && (!bStill || first.duration() < second.duration())) {
    first = holdLike(a, second);
  } else if (bStill) {
    second = holdLike(b, first);
  }
}

// Frame by frame; the speed of both times `speed`.
std::vector<MixMoment> playedMoments(const Together& together, double weight, double frameSeconds, double speed) {
  JointClock clock(together.phases, together.phases.a.when(together.from));
  std::vector<MixMoment> moments;
  while (clock.phase() <= together.to + kBlending.samePhase) {
    moments.push_back({clock.a(), clock.b(), weight});
    if (moments.size() > kMaxClipFrames) {
      throw Error(ErrorCode::kLimit, "the blend has too many frames", together.a.name(), "choose a lower frame rate");
    }
    clock.advance(frameSeconds * speed, weight, weight);
  }
  return moments;
}

// So that a loop ends on a frame.
double speedToClose(const Together& together, double weight, double frameSeconds) {
  const std::vector<MixMoment> moments = playedMoments(together, weight, frameSeconds, 1);
  const double last = together.phases.a.at(*moments.back().a);
  JointClock clock(together.phases, *moments.back().a);
  clock.advance(frameSeconds, weight, weight);
  const double frames = static_cast<double>(moments.size() - 1) +
                        (together.to - last) / std::max(clock.phase() - last, kBlending.samePhase);
  return frames / std::max(1.0, std::round(frames));
}

}  // namespace

ClipWithContacts blendMotions(const Skeleton& skeleton, const ClipWithContacts& a, const ClipWithContacts& b,
                              const BlendOptions& options, Warnings* warnings) {
  if (!(options.weight >= 0 && options.weight <= 1)) {
    throw Error(ErrorCode::kBadArgument, fmt::format("the weight of a blend is {:g}", options.weight), "",
                "it is from 0 to 1");
  }
  const MixBody body(skeleton);
  MixMotion first(body, a), second(body, b);
  holdPoses(body, a.clip, b.clip, first, second);
  const double frameSeconds =
      options.frameRate ? 1 / *options.frameRate : std::min(first.frameSeconds(), second.frameSeconds());
  const Together together = playedTogether(std::move(first), std::move(second), options.weight);
  if (warnings) warnOfRates(together, options.weight, *warnings);
  const double speed = together.loops ? speedToClose(together, options.weight, frameSeconds) : 1;
  const std::vector<MixMoment> moments = playedMoments(together, options.weight, frameSeconds, speed);
  MixedFrames mixed = mixFrames(body, together.a, together.b, together.phases, moments, frameSeconds, together.start);
  plantMixedFeet(body, {0, mixed.frames.poses.size(), together.loops}, mixed);
  return {clipOf(skeleton, body.plain().original(mixed.frames), a.clip.name), mixed.plantedFeet(body)};
}

}  // namespace limber
