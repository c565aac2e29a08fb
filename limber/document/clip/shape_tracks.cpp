#include "limber/document/clip/shape_tracks.h"

#include "limber/document/gltf/accessor.h"

namespace limber {

namespace {

std::size_t perKeyOf(const gltf::AnimationSampler& sampler) {
  return sampler.interpolation == Interpolation::kCubic ? 3 : 1;
}

std::uint64_t numbersIn(const Asset& asset, Index accessor) {
  const AccessorInfo info = accessorInfo(asset, accessor);
  return std::uint64_t{info.count} * info.components;
}

// That of the last channel for the node's weights with values for all of its keys; null where there is none.
const gltf::AnimationSampler* shapeSampler(const Asset& asset, Index node, std::size_t count, Index clip) {
  const gltf::Animation& animation = asset.document.animations[clip];
  for (auto channel = animation.channels.rbegin(); channel != animation.channels.rend(); ++channel) {
    if (channel->target.node != node || channel->target.path != "weights") continue;
    const gltf::AnimationSampler& sampler = animation.samplers[channel->sampler];
    const std::uint64_t keys = numbersIn(asset, sampler.input);
    if (keys > 0 && numbersIn(asset, sampler.output) >= keys * perKeyOf(sampler) * count) return &sampler;
  }
  return nullptr;
}

}  // namespace

std::vector<Track<float>> shapeTracks(const Asset& asset, Index node, std::size_t count, std::optional<Index> clip) {
  const std::vector<double>& own = asset.document.nodes[node].weights;
  const std::vector<double>& standing =
      own.empty() ? asset.document.meshes[*asset.document.nodes[node].mesh].weights : own;
  std::vector<Track<float>> tracks(count);
  for (std::size_t s = 0; s < count; ++s) {
    tracks[s].times = {0};
    tracks[s].values = {s < standing.size() ? static_cast<float>(standing[s]) : 0.0f};
  }
  const gltf::AnimationSampler* sampler = clip ? shapeSampler(asset, node, count, *clip) : nullptr;
  if (sampler == nullptr) return tracks;
  const std::vector<float> times = readFloats(asset, sampler->input), values = readFloats(asset, sampler->output);
  for (std::size_t s = 0; s < count; ++s) {
    tracks[s] = {0, sampler->interpolation, times, {}};
    for (std::size_t k = 0; k < times.size() * perKeyOf(*sampler); ++k) {
      tracks[s].values.push_back(values[k * count + s]);
    }
  }
  return tracks;
}

std::uint64_t shapeTrackSize(const Asset& asset, Index node, std::size_t count, Index clip) {
  const gltf::AnimationSampler* sampler = shapeSampler(asset, node, count, clip);
  return sampler == nullptr ? 0 : numbersIn(asset, sampler->input) * (1 + perKeyOf(*sampler)) * count;
}

}  // namespace limber
