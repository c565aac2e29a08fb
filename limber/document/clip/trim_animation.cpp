#include "limber/document/clip/trim_animation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/scene/node_edit.h"
#include "limber/skeleton/clip/clip_edit.h"
#include "limber/skeleton/clip/join_loop.h"

namespace limber {

namespace {

std::size_t valuesPerKey(Interpolation interpolation) {
  return interpolation == Interpolation::kCubic ? 3 : 1;
}

// What a sampler says, each value of `width` numbers.
struct SamplerKeys {
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times, numbers;
  std::size_t width = 0;
};

std::optional<SamplerKeys> readKeys(const Asset& asset, const gltf::AnimationSampler& sampler) {
  SamplerKeys keys{sampler.interpolation, readFloats(asset, sampler.input), readFloats(asset, sampler.output)};
  const std::size_t values = keys.times.size() * valuesPerKey(keys.interpolation);
  if (values == 0 || keys.numbers.empty() || keys.numbers.size() % values != 0) return std::nullopt;
  keys.width = keys.numbers.size() / values;
  const auto finite = [](float number) { return std::isfinite(number); };
  if (!std::all_of(keys.times.begin(), keys.times.end(), finite) ||
      std::adjacent_find(keys.times.begin(), keys.times.end(), std::greater_equal()) != keys.times.end()) {
    return std::nullopt;
  }
  return keys;
}

// One key where the span is empty: everything ends before it.
template <typename Value>
Track<Value> trimmedTrack(const Track<Value>& whole, const TimeSpan& span) {
  const bool still = !(span.from < span.to);
  Track<Value> track = trimTrack(whole, span.from, still ? span.from + 1 : span.to);
  if (still) {
    track.times.resize(1);
    track.values.resize(valuesPerKey(track.interpolation));
  }
  return track;
}

SamplerKeys trimmedRotations(const SamplerKeys& keys, const TimeSpan& span) {
  const std::size_t perKey = valuesPerKey(keys.interpolation);
  std::vector<Eigen::Quaternionf> values;
  for (std::size_t v = 0; v < keys.numbers.size() / 4; ++v) {
    values.emplace_back(keys.numbers.data() + 4 * v);
    if (v % perKey == perKey / 2) values.back().normalize();
  }
  const Track<Eigen::Quaternionf> track =
      trimmedTrack(Track<Eigen::Quaternionf>{0, keys.interpolation, keys.times, std::move(values)}, span);
  SamplerKeys result{track.interpolation, track.times, {}, 4};
  for (const Eigen::Quaternionf& value : track.values) {
    result.numbers.insert(result.numbers.end(), value.coeffs().begin(), value.coeffs().end());
  }
  return result;
}

// Three numbers at a time.
template <typename Change>
SamplerKeys changedNumbers(const SamplerKeys& keys, const Change& change) {
  SamplerKeys result{keys.interpolation, {}, {}, keys.width};
  for (std::size_t first = 0; first < keys.width; first += 3) {
    const std::size_t count = std::min<std::size_t>(3, keys.width - first);
    std::vector<Vec3f> values(keys.numbers.size() / keys.width, Vec3f::Zero());
    for (std::size_t v = 0; v < values.size(); ++v) {
      std::copy_n(keys.numbers.data() + v * keys.width + first, count, values[v].data());
    }
    const Track<Vec3f> track = change(Track<Vec3f>{0, keys.interpolation, keys.times, std::move(values)});
    result.interpolation = track.interpolation;
    result.times = track.times;
    result.numbers.resize(track.values.size() * keys.width);
    for (std::size_t v = 0; v < track.values.size(); ++v) {
      std::copy_n(track.values[v].data(), count, result.numbers.data() + v * keys.width + first);
    }
  }
  return result;
}

// Does each number end as it begins?
bool isClosed(const SamplerKeys& keys) {
  const std::size_t perKey = valuesPerKey(keys.interpolation), value = perKey / 2 * keys.width;
  const auto first = keys.numbers.begin() + static_cast<std::ptrdiff_t>(value);
  const auto last = keys.numbers.end() - static_cast<std::ptrdiff_t>(perKey * keys.width - value);
  return std::equal(first, first + static_cast<std::ptrdiff_t>(keys.width), last,
                    [](float a, float b) { return std::abs(a - b) <= kClosedLoop; });
}

// Switches stay whole numbers.
Index addValues(Asset& asset, AccessorInfo info, const std::vector<float>& numbers) {
  if (info.normalized || info.type == ComponentType::kF32) return addFloatAccessor(asset, numbers, info.components);
  info.count = static_cast<Index>(numbers.size() / info.components);
  Bytes bytes(numbers.size() * componentSize(info.type));
  withComponentType(info.type, [&](auto component) {
    using T = decltype(component);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      constexpr double kMin = std::numeric_limits<T>::lowest(), kMax = std::numeric_limits<T>::max();
      const auto whole = static_cast<T>(std::clamp(std::round(double{numbers[i]}), kMin, kMax));
      std::memcpy(bytes.data() + i * sizeof(T), &whole, sizeof(T));
    }
  });
  return addAccessor(asset, info, bytes);
}

void cutAnimation(Asset& asset, gltf::Animation& animation, const TimeSpan& span, bool joinsWeights) {
  std::vector<bool> isRotation(animation.samplers.size(), false), isJoined(animation.samplers.size(), false);
  for (const gltf::AnimationChannel& channel : animation.channels) {
    const std::string path = channelTarget(channel).path;
    if (path == "rotation") isRotation[channel.sampler] = true;
    if (path.rfind("weights", 0) == 0) isJoined[channel.sampler] = joinsWeights;
  }
  std::vector<std::optional<SamplerKeys>> all;
  double duration = 0;
  for (const gltf::AnimationSampler& sampler : animation.samplers) {
    all.push_back(readKeys(asset, sampler));
    if (all.back()) duration = std::max(duration, double{all.back()->times.back()});
  }
  const TimeSpan within{std::max(span.from, 0.0), std::min(span.to, duration)};
  std::map<std::vector<float>, Index> inputs;
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (!all[s]) {
      asset.warnings.add("invalid-keys", "animation keys that are not in order are not cut", animation.name);
      continue;
    }
    const bool turns = isRotation[s] && all[s]->width == 4;
    SamplerKeys keys = turns ? trimmedRotations(*all[s], within)
                             : changedNumbers(*all[s], [&](const auto& track) { return trimmedTrack(track, within); });
    if (isJoined[s] && !isClosed(keys)) keys = changedNumbers(keys, joinTrack);
    gltf::AnimationSampler& sampler = animation.samplers[s];
    const auto [input, isNew] = inputs.try_emplace(keys.times, 0);
    if (isNew) input->second = addFloatAccessor(asset, keys.times, 1, 0, true);
    sampler.input = input->second;
    sampler.output = addValues(asset, accessorInfo(asset, sampler.output), keys.numbers);
    sampler.interpolation = keys.interpolation;
  }
}

}  // namespace

void trimAnimation(Asset& asset, gltf::Animation& animation, const TimeSpan& span) {
  cutAnimation(asset, animation, span, false);
}

void loopAnimation(Asset& asset, gltf::Animation& animation, const TimeSpan& span) {
  cutAnimation(asset, animation, span, true);
}

}  // namespace limber
