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
                              PreviewOptions options, Warnings& warnings) {
  std::vector<Scene> scenes;
  Box frame;
  for (const double moment : seconds) {
    scenes.push_back(sceneAt(asset, clip, moment));
    for (const Vec3f& position : scenes.back().positions) frame.add(position.cast<double>());
  }
  if (!scenes.empty()) warnings = scenes.front().warnings;
  if (!options.frame) options.frame = frame;
  std::vector<Image> images;
  images.reserve(scenes.size());
  for (const Scene& scene : scenes) images.push_back(render(scene, options));
  return images;
}

}  // namespace limber
