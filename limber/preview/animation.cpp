#include "limber/preview/animation.h"

#include "limber/core/error.h"

namespace limber {

std::vector<double> clipMoments(const Clip& clip, int count, bool withEnd) {
  if (count < 1) throw Error(ErrorCode::kBadArgument, "a clip is shown in one picture at least");
  std::vector<double> moments;
  moments.reserve(static_cast<std::size_t>(count));
  const int steps = std::max(1, withEnd ? count - 1 : count);
  for (int i = 0; i < count; ++i) moments.push_back(clip.duration() * i / steps);
  return moments;
}

std::vector<Image> renderClip(const Asset& asset, const Clip& clip, std::span<const double> seconds,
                              PreviewOptions options, Progress& progress, Warnings& warnings) {
  Box frame;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    progress.update(0.2 * static_cast<double>(i) / static_cast<double>(seconds.size()));
    const Scene scene = sceneAt(asset, clip, seconds[i]);
    for (const Vec3f& position : scene.positions) frame.add(position.cast<double>());
    if (i == 0) warnings = scene.warnings;
  }
  if (!options.frame) options.frame = frame;
  std::vector<Image> images;
  images.reserve(seconds.size());
  for (const double moment : seconds) {
    progress.update(0.2 + 0.8 * static_cast<double>(images.size()) / static_cast<double>(seconds.size()));
    images.push_back(render(sceneAt(asset, clip, moment), options));
  }
  return images;
}

}  // namespace limber
