#include "limber/document/clip/animation_repair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "limber/core/file/read_bounds.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

bool isPartOf(const gltf::Node& node, std::string_view path) {
  return path == "translation" || path == "rotation" || path == "scale" || (path == "weights" && node.mesh);
}

using Targets = std::set<std::pair<Index, std::string>>;

Targets plainTargets(const gltf::Animation& animation) {
  Targets targets;
  for (const gltf::AnimationChannel& channel : animation.channels) {
    if (channel.target.node) targets.insert({*channel.target.node, channel.target.path});
  }
  return targets;
}

void resolvePointer(const gltf::Document& document, gltf::AnimationChannel& channel, Targets& taken) {
  const ChannelTarget named = channelTarget(channel);
  if (!named.node || *named.node >= document.nodes.size() || !isPartOf(document.nodes[*named.node], named.path)) return;
  if (!taken.insert({*named.node, named.path}).second) return;
  eraseExtension(channel.target, kPointerName);
  channel.target.node = named.node;
  channel.target.path = named.path;
}

// True if one went. Samplers that no channel names any more stay: those that are left may name some that are not there.
bool dropLostPointers(gltf::Document& document, Warnings& warnings) {
  bool any = false;
  const auto isLost = [&](const gltf::AnimationChannel& channel) {
    const std::optional<Index> node = channelTarget(channel).node;
    return animationPointer(channel.target) != nullptr && node && *node >= document.nodes.size();
  };
  std::erase_if(document.animations, [&](gltf::Animation& animation) {
    const std::size_t dropped = std::erase_if(animation.channels, isLost);
    warnings.add("missing-targets", "animation channels of nodes that are not there are left out", animation.name,
                 dropped);
    any = any || dropped > 0;
    return dropped > 0 && animation.channels.empty();
  });
  return any;
}

// Moves the keys of animations.
class KeyShifter {
 public:
  explicit KeyShifter(Asset& asset) : asset_(asset) {}

  // The earliest finite time of an animation's keys, if that is before 0, else 0.
  float firstTime(const gltf::Animation& animation) {
    float first = 0;
    for (const gltf::AnimationSampler& sampler : animation.samplers) {
      const auto [known, isNew] = firstOf_.try_emplace(sampler.input, 0.0f);
      if (isNew) {
        for (const float time : readFloats(asset_, sampler.input)) {
          if (std::isfinite(time)) known->second = std::min(known->second, time);
        }
      }
      first = std::min(first, known->second);
    }
    return first;
  }

  void delay(Index animation, float seconds) {
    for (gltf::AnimationSampler& sampler : asset_.document.animations[animation].samplers) {
      const auto [known, isNew] = shifted_.try_emplace({sampler.input, seconds}, 0);
      if (isNew) {
        std::vector<float> times = readFloats(asset_, sampler.input);
        for (float& time : times) time += seconds;
        known->second = addTimes(times);
      }
      sampler.input = known->second;
    }
  }

 private:
  // Animations that share times get copies: a few kilobytes must not ask for gigabytes.
  Index addTimes(const std::vector<float>& times) {
    added_ += times.size();
    if (added_ > read_bounds::kMovedTimes.of(0))
      throw Error(ErrorCode::kLimit, "has too many keys in clips with keys before 0 s");
    return addFloatAccessor(asset_, times, 1, 0, true);
  }

  Asset& asset_;
  std::map<Index, float> firstOf_;                    // by accessor
  std::map<std::pair<Index, float>, Index> shifted_;  // by accessor and seconds
  std::size_t added_ = 0;
};

}  // namespace

void resolveNodePointers(gltf::Document& document, Warnings& warnings) {
  bool had = dropLostPointers(document, warnings), has = false;
  for (gltf::Animation& animation : document.animations) {
    Targets taken = plainTargets(animation);
    for (gltf::AnimationChannel& channel : animation.channels) {
      if (animationPointer(channel.target) == nullptr) continue;
      had = true;
      resolvePointer(document, channel, taken);
      has = has || animationPointer(channel.target) != nullptr;
    }
  }
  if (had && !has) undeclareExtension(document, kPointerName);
}

void startAtZero(Asset& asset) {
  const std::vector<gltf::Animation>& animations = asset.document.animations;
  std::vector<float> first;
  KeyShifter keys(asset);
  for (const gltf::Animation& animation : animations) first.push_back(keys.firstTime(animation));
  if (std::none_of(first.begin(), first.end(), [](float time) { return time < 0; })) return;
  const AccessorSweep accessors(asset);
  const BufferViewSweep views(asset);
  for (Index a = 0; a < first.size(); ++a) {
    if (!(first[a] < 0)) continue;
    keys.delay(a, -first[a]);
    asset.warnings.add("negative-times", "clips with keys before 0 s are moved to begin there", animations[a].name);
  }
  accessors.sweep(asset);
  views.sweep(asset);
}

}  // namespace limber
