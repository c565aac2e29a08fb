#include "limber/skeleton/clip/keep_duration.h"

namespace limber {

namespace {

template <typename Value>
bool hold(std::vector<Track<Value>>& tracks, const std::vector<float>& times) {
  if (tracks.empty() || tracks.front().interpolation == Interpolation::kCubic) return false;
  Track<Value>& first = tracks.front();
  first.values.assign(times.size(), Value(first.values.back()));
  first.times = times;
  return true;
}

}  // namespace

void keepDuration(Clip& clip, const std::vector<float>& times) {
  if (times.empty() || !(clip.duration() < times.back())) return;
  if (!hold(clip.rotations, times) && !hold(clip.translations, times)) hold(clip.scales, times);
}

}  // namespace limber
