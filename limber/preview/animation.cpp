#include "limber/preview/animation.h"

#include <algorithm>
#include <cmath>

#include "limber/core/error.h"

namespace limber {

std::vector<double> clipMoments(double duration, int count, bool withEnd) {
  if (count < 1) throw Error(ErrorCode::kBadArgument, "a clip is shown in one picture at least");
  std::vector<double> moments;
  moments.reserve(static_cast<std::size_t>(count));
  const int steps = std::max(1, withEnd ? count - 1 : count);
  for (int i = 0; i < count; ++i) moments.push_back(duration * i / steps);
  return moments;
}

std::vector<Image> renderClip(const SceneMaker& scenes, const Clip& clip, std::span<const double> seconds,
                              PreviewOptions options, Progress& progress, Warnings& warnings) {
  Box frame;
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    progress.update(0.2 * static_cast<double>(i) / static_cast<double>(seconds.size()));
    const Scene scene = scenes.at(clip, seconds[i]);
    for (const Vec3f& position : scene.positions) frame.add(position.cast<double>());
    if (i == 0) warnings = scene.warnings;
  }
  if (!options.frame) options.frame = frame;
  std::vector<Image> images;
  images.reserve(seconds.size());
  for (const double moment : seconds) {
    progress.update(0.2 + 0.8 * static_cast<double>(images.size()) / static_cast<double>(seconds.size()));
    images.push_back(render(scenes.at(clip, moment), options));
  }
  return images;
}

std::vector<Image> renderTurn(const Scene& scene, PreviewOptions options, int count, Progress& progress) {
  if (count < 1) throw Error(ErrorCode::kBadArgument, "a turn is shown in one picture at least");
  // The same seen from all around.
  Box frame;
  for (const Vec3f& position : scene.positions) frame.add(position.cast<double>());
  const Vec3 middle = frame.center();
  double reach = 0;
  for (const Vec3f& position : scene.positions) {
    reach = std::max(reach, std::hypot(position.x() - middle.x(), position.z() - middle.z()));
  }
  frame.add(Vec3(middle.x() - reach, middle.y(), middle.z() - reach));
  frame.add(Vec3(middle.x() + reach, middle.y(), middle.z() + reach));
  options.frame = frame;

  std::vector<Image> images;
  images.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    progress.update(static_cast<double>(i) / count);
    options.turn = 360.0 * i / count;
    images.push_back(render(scene, options));
  }
  return images;
}

}  // namespace limber
