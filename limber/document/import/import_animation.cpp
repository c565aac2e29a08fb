#include "limber/document/import/import_animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <assimp/scene.h>

#include "limber/document/gltf/accessor.h"
#include "limber/document/import/import_text.h"

namespace limber {

namespace {

constexpr double kDefaultTicks = 25;  // a second, where the file does not say

// One path of one node over time.
struct Track {
  std::vector<float> times;
  std::vector<float> values;  // #times * components
};

class AnimationImporter {
 public:
  AnimationImporter(Asset& asset, const aiAnimation& source, double scale) : asset_(asset), scale_(scale) {
    animation_.name = textOf(source.mName);
    if (source.mTicksPerSecond > 0 && std::isfinite(source.mTicksPerSecond)) ticks_ = source.mTicksPerSecond;
  }

  void addChannels(const aiNodeAnim& channel, Index node) {
    addTrack(node, "translation", 3,
             track(
                 channel.mPositionKeys, channel.mNumPositionKeys,
                 [&](const aiVectorKey& k) {
                   return std::array<double, 4>{scale_ * k.mValue.x, scale_ * k.mValue.y, scale_ * k.mValue.z, 0};
                 },
                 3));
    Track rotation = track(
        channel.mRotationKeys, channel.mNumRotationKeys,
        [](const aiQuatKey& k) {
          const double length = std::hypot(std::hypot(k.mValue.x, k.mValue.y), std::hypot(k.mValue.z, k.mValue.w));
          return std::array<double, 4>{k.mValue.x / length, k.mValue.y / length, k.mValue.z / length,
                                       k.mValue.w / length};
        },
        4);
    keepNearSide(rotation);
    addTrack(node, "rotation", 4, rotation);
    addTrack(node, "scale", 3,
             track(
                 channel.mScalingKeys, channel.mNumScalingKeys,
                 [](const aiVectorKey& k) {
                   return std::array<double, 4>{k.mValue.x, k.mValue.y, k.mValue.z, 0};
                 },
                 3));
  }

  gltf::Animation take() && { return std::move(animation_); }

 private:
  template <typename Key, typename Value>
  Track track(const Key* keys, unsigned count, const Value& value, std::size_t components) {
    std::vector<unsigned> order(count);
    for (unsigned i = 0; i < count; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](unsigned a, unsigned b) { return keys[a].mTime < keys[b].mTime; });
    Track result;
    for (const unsigned i : order) {
      const auto time = static_cast<float>(keys[i].mTime / ticks_);
      const std::array<double, 4> numbers = value(keys[i]);
      const bool finite = std::all_of(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(components),
                                      [](double x) { return std::isfinite(static_cast<float>(x)); });
      if (!(time >= 0) || !std::isfinite(time) || !finite) {
        asset_.warnings.add("invalid-keys", "animation keys that are not finite or before the start are left out");
        continue;
      }
      if (!result.times.empty() && time <= result.times.back()) {
        result.values.erase(result.values.end() - static_cast<std::ptrdiff_t>(components), result.values.end());
        result.times.pop_back();
      }
      result.times.push_back(time);
      for (std::size_t c = 0; c < components; ++c) result.values.push_back(static_cast<float>(numbers[c]));
    }
    return result;
  }

  // q and -q are the same rotation, but interpolation to them takes different paths.
  static void keepNearSide(Track& rotation) {
    for (std::size_t i = 4; i + 3 < rotation.values.size(); i += 4) {
      double dot = 0;
      for (std::size_t c = i; c < i + 4; ++c) dot += double{rotation.values[c]} * rotation.values[c - 4];
      for (std::size_t c = i; dot < 0 && c < i + 4; ++c) rotation.values[c] = -rotation.values[c];
    }
  }

  void addTrack(Index node, const char* path, Index components, const Track& track) {
    if (track.times.empty()) return;
    const Index output = addFloatAccessor(asset_, track.values, components);
    const Index sampler = addElement(animation_.samplers, {{}, input(track.times), output});
    animation_.channels.push_back({{}, sampler, {{}, node, path}});
  }

  // Most tracks of a clip have the same times: they share one accessor.
  Index input(const std::vector<float>& times) {
    const auto known = inputs_.find(times);
    if (known != inputs_.end()) return known->second;
    return inputs_[times] = addFloatAccessor(asset_, times, 1, 0, true);
  }

  Asset& asset_;
  double scale_;
  double ticks_ = kDefaultTicks;
  gltf::Animation animation_;
  std::map<std::vector<float>, Index> inputs_;
};

}  // namespace

void importAnimations(Asset& asset, const aiScene& scene, const std::map<const aiNode*, Index>& nodeOf, double scale) {
  std::map<std::string, Index> nodeByName;
  for (const auto& [node, index] : nodeOf) {
    // Of nodes of one name the first in the tree is meant.
    const auto [known, isNew] = nodeByName.try_emplace(std::string(node->mName.data, node->mName.length), index);
    if (!isNew) known->second = std::min(known->second, index);
  }
  for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
    const aiAnimation& source = *scene.mAnimations[a];
    AnimationImporter importer(asset, source, scale);
    std::set<Index> moved;
    for (unsigned c = 0; c < source.mNumChannels; ++c) {
      const aiNodeAnim& channel = *source.mChannels[c];
      const auto node = nodeByName.find(std::string(channel.mNodeName.data, channel.mNodeName.length));
      const bool isNew = node != nodeByName.end() && moved.insert(node->second).second;
      if (isNew) importer.addChannels(channel, node->second);
    }
    gltf::Animation animation = std::move(importer).take();
    if (!animation.channels.empty()) asset.document.animations.push_back(std::move(animation));
  }
}

}  // namespace limber
