#include "limber/asset/shape_tracks.h"

#include "limber/asset/accessor.h"

namespace limber {

std::vector<Track<float>> shapeTracks(const Asset& asset, Index node, std::size_t count, std::optional<Index> clip) {
  const std::vector<double>& own = asset.document.nodes[node].weights;
  const std::vector<double>& standing =
      own.empty() ? asset.document.meshes[*asset.document.nodes[node].mesh].weights : own;
  std::vector<Track<float>> tracks(count);
  for (std::size_t s = 0; s < count; ++s) {
    tracks[s].times = {0};
    tracks[s].values = {s < standing.size() ? static_cast<float>(standing[s]) : 0.0f};
  }
  if (!clip) return tracks;
  const gltf::Animation& animation = asset.document.animations[*clip];
  for (const gltf::AnimationChannel& channel : animation.channels) {
    if (channel.target.node != node || channel.target.path != "weights") continue;
    const gltf::AnimationSampler& sampler = animation.samplers[channel.sampler];
    const std::vector<float> times = readFloats(asset, sampler.input), values = readFloats(asset, sampler.output);
    const std::size_t perKey = sampler.interpolation == Interpolation::kCubic ? 3 : 1;
    if (times.empty() || values.size() < times.size() * perKey * count) continue;
    for (std::size_t s = 0; s < count; ++s) {
      tracks[s] = {0, sampler.interpolation, times, {}};
      for (std::size_t k = 0; k < times.size() * perKey; ++k) tracks[s].values.push_back(values[k * count + s]);
    }
  }
  return tracks;
}

}  // namespace limber
