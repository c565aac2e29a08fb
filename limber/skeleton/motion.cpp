#include "limber/skeleton/motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/skeleton/clip/tracks.h"

namespace limber {

void checkMotion(const Motion& motion) {
  checkSkeleton(motion.skeleton);
  for (const Clip& clip : motion.clips) {
    try {
      checkClip(clip, motion.skeleton);
    } catch (const Error& error) {
      throw error.within(fmt::format("clip '{}'", clip.name));
    }
  }
  if (!(motion.framesPerSecond > 0) || !std::isfinite(motion.framesPerSecond)) {
    throw Error(ErrorCode::kBadData, fmt::format("has {} frames a second", motion.framesPerSecond));
  }
}

std::vector<float> longestTimes(const Clip& clip) {
  std::vector<float> times;
  forEachTrack(clip, [&](const auto& track) {
    if (track.times.size() > times.size()) times = track.times;
  });
  return times;
}

std::optional<double> measuredFrameRate(const Clip& clip) {
  const std::vector<float> times = longestTimes(clip);
  if (times.size() < 2) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t k = 1; k < times.size(); ++k) steps.push_back(double{times[k]} - times[k - 1]);
  const auto median = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), median, steps.end());
  if (!(*median > 0)) return std::nullopt;
  // Times in single precision: late in a long clip the steps are coarse, and 30 frames a second come out as 29.9999.
  constexpr double kEven = 0.02, kRounding = 2e-5;
  std::size_t last = times.size() - 1;
  const double lastStep = double{times[last]} - times[last - 1];
  if (last > 1 && std::abs(lastStep - *median) > kEven * *median) --last;  // a clip may end between two frames
  const double mean = (double{times[last]} - times.front()) / static_cast<double>(last);
  const double rate = 1 / (std::abs(mean - *median) < kEven * *median ? mean : *median), whole = std::round(rate);
  return std::abs(rate - whole) < kRounding * whole ? whole : rate;
}

double frameRateOf(const Clip& clip) {
  return std::clamp(measuredFrameRate(clip).value_or(30), 1.0, 1000.0);
}

double denseFrameRateOf(const Clip& clip) {
  constexpr double kSparse = 20, kDense = 30, kRounding = 1e-9;
  const double rate = frameRateOf(clip);
  return rate < kSparse ? rate * std::ceil(kDense / rate - kRounding) : rate;
}

double frameRateOf(const Motion& motion, std::size_t clip) {
  constexpr double kSame = 1e-3;
  const double measured = measuredFrameRate(motion.clips[clip]).value_or(motion.framesPerSecond);
  return std::abs(measured - motion.framesPerSecond) < kSame * measured ? motion.framesPerSecond : measured;
}

Index frameCount(const Clip& clip, double framesPerSecond) {
  if (!(framesPerSecond > 0) || !std::isfinite(framesPerSecond)) {
    throw Error(ErrorCode::kBadArgument, fmt::format("{} is no frame rate", framesPerSecond));
  }
  const double last = std::round(std::max(0.0, clip.duration()) * framesPerSecond);
  constexpr double kMaxFrames = 1 << 30;
  if (!(last < kMaxFrames)) {
    throw Error(ErrorCode::kLimit, fmt::format("has {:.0f} frames at {:g} a second", last, framesPerSecond),
                fmt::format("clip '{}'", clip.name));
  }
  return static_cast<Index>(last) + 1;
}

}  // namespace limber
