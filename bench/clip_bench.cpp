// Playing a clip: from keys to global matrices.
#include <cmath>

#include <benchmark/benchmark.h>

#include "limber/skeleton/clip/clip_player.h"

namespace limber {
namespace {

// 60 joints in chains of 12, keys 30 times a second for both rotations and translations; `offset`: seconds by which
// each joint's keys come later than those of the one before.
void clipPlayer(benchmark::State& state, double offset) {
  Skeleton skeleton;
  Clip clip;
  for (Index j = 0; j < 60; ++j) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = "joint";
    joint.name.push_back(static_cast<char>('0' + j));
    if (j > 0) joint.parent = j % 12 == 0 ? 0 : j - 1;
    Track<Eigen::Quaternionf> turns{j, Interpolation::kLinear, {}, {}};
    Track<Vec3f> moves{j, Interpolation::kLinear, {}, {}};
    for (int k = 0; k < 300; ++k) {
      const auto angle = static_cast<float>(0.5 * std::sin(0.07 * k + j));
      turns.times.push_back(static_cast<float>(k / 30.0 + offset * j));
      turns.values.push_back(Eigen::Quaternionf(Eigen::AngleAxisf(angle, Vec3f(1, 1, 0).normalized())));
      moves.values.push_back(Vec3f(0, 0.1f, 0.01f * angle));
    }
    moves.times = turns.times;
    clip.rotations.push_back(turns);
    clip.translations.push_back(moves);
  }
  ClipPlayer player(clip, skeleton);
  std::vector<Eigen::Matrix4f> globals(60);
  const double framesPerSecond = static_cast<double>(state.range(0));
  double seconds = 0;
  for (auto _ : state) {
    seconds += 1 / framesPerSecond;
    if (seconds > 9.9) seconds = 0;
    player.sample(seconds, globals);
    benchmark::DoNotOptimize(globals.data());
  }
  state.SetItemsProcessed(state.iterations() * 60);
}
BENCHMARK_CAPTURE(clipPlayer, recorded, 0.0)->Arg(60)->Arg(1000);
BENCHMARK_CAPTURE(clipPlayer, ownTimes, 0.001)->Arg(60)->Arg(1000);

}  // namespace
}  // namespace limber
