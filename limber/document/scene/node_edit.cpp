#include "limber/document/scene/node_edit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/references.h"
#include "limber/document/scene/mirrored_scale.h"

namespace limber {

double shortDouble(double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) throw Error(ErrorCode::kBadData, "a node lies beyond what single precision can hold");
  return Json::parse(fmt::format("{}", single)).get<double>();
}

void setNodeTransform(gltf::Node& node, const Affine& local, bool mayHaveMatrix) {
  const Vec3 half = halfTurnOfMirror(node.scale.value_or(Vec3::Ones()));
  node.clearTransform();
  bool sheared = false;
  Transform t = decompose(local, &sheared);
  if (half != Vec3::Ones()) t = turnedMirror(t, half);
  if (sheared && mayHaveMatrix) {
    node.matrix = local.matrix().unaryExpr(&shortDouble);
    return;
  }
  if (t.translation != Vec3::Zero()) node.translation = t.translation.unaryExpr(&shortDouble);
  if (t.rotation.coeffs() != Quat::Identity().coeffs()) node.rotation = t.rotation.coeffs().unaryExpr(&shortDouble);
  if (t.scale != Vec3::Ones()) node.scale = t.scale.unaryExpr(&shortDouble);
}

namespace {

constexpr std::string_view kPointerStart = "/nodes/";

// "/nodes/12/rotation" -> 12, "rotation".
ChannelTarget parsePointer(const std::string& pointer) {
  if (pointer.rfind(kPointerStart, 0) != 0) return {};
  std::size_t at = kPointerStart.size();
  std::uint64_t number = 0;
  while (at < pointer.size() && pointer[at] >= '0' && pointer[at] <= '9' && number < kNoIndex) {
    number = 10 * number + static_cast<std::uint64_t>(pointer[at++] - '0');
  }
  if (at == kPointerStart.size() || number >= kNoIndex) return {};
  return {static_cast<Index>(number), at < pointer.size() ? pointer.substr(at + 1) : std::string()};
}

}  // namespace

void removeUnusedSamplers(gltf::Animation& animation) {
  std::vector<Index> newIndex(animation.samplers.size(), kNoIndex);
  for (const gltf::AnimationChannel& channel : animation.channels) newIndex.at(channel.sampler) = 0;
  std::vector<gltf::AnimationSampler> kept;
  for (Index s = 0; s < newIndex.size(); ++s) {
    if (newIndex[s] != kNoIndex) newIndex[s] = addElement(kept, std::move(animation.samplers[s]));
  }
  for (gltf::AnimationChannel& channel : animation.channels) channel.sampler = newIndex[channel.sampler];
  animation.samplers = std::move(kept);
}

ChannelTarget channelTarget(const gltf::AnimationChannel& channel) {
  if (const std::string* pointer = animationPointer(channel.target)) return parsePointer(*pointer);
  return {channel.target.node, channel.target.path};
}

bool removeChannels(gltf::Animation& animation, const std::function<bool(Index, std::string_view)>& drop) {
  const std::size_t dropped = std::erase_if(animation.channels, [&](const gltf::AnimationChannel& channel) {
    const ChannelTarget target = channelTarget(channel);
    return target.node && drop(*target.node, target.path);
  });
  if (dropped > 0) removeUnusedSamplers(animation);
  return dropped > 0;
}

void removeChannels(Asset& asset, const std::function<bool(Index, std::string_view)>& drop) {
  std::erase_if(asset.document.animations, [&](gltf::Animation& animation) {
    return removeChannels(animation, drop) && animation.channels.empty();
  });
}

void appendChannels(gltf::Animation& to, gltf::Animation& from) {
  const auto offset = static_cast<Index>(to.samplers.size());
  for (gltf::AnimationSampler& sampler : from.samplers) to.samplers.push_back(std::move(sampler));
  for (gltf::AnimationChannel& channel : from.channels) {
    channel.sampler += offset;
    to.channels.push_back(std::move(channel));
  }
  from.channels.clear();
}

void moveLastAnimations(gltf::Document& document, std::span<const Index> into) {
  const std::size_t first = document.animations.size() - into.size();
  for (std::size_t i = 0; i < into.size(); ++i) {
    appendChannels(document.animations[into[i]], document.animations[first + i]);
  }
  document.animations.resize(first);
}

void retargetMorphChannels(Asset& asset, Index from, Index to) {
  for (gltf::Animation& animation : asset.document.animations) {
    for (gltf::AnimationChannel& channel : animation.channels) {
      const ChannelTarget target = channelTarget(channel);
      if (target.node != from || target.path.rfind("weights", 0) != 0) continue;
      if (animationPointer(channel.target) != nullptr) {
        setAnimationPointer(channel.target, fmt::format("{}{}/{}", kPointerStart, to, target.path));
      } else {
        channel.target.node = to;
      }
    }
  }
  moveVrmMesh(asset.document, from, to);
}

void deleteNodes(Asset& asset, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;
  removeChannels(asset, [&](Index node, std::string_view) { return node < keep.size() && !keep[node]; });

  gltf::Document& document = asset.document;
  std::vector<Index> newIndex(keep.size(), kNoIndex);
  std::vector<gltf::Node> kept;
  for (Index n = 0; n < keep.size(); ++n) {
    if (keep[n]) newIndex[n] = addElement(kept, std::move(document.nodes[n]));
  }
  document.nodes = std::move(kept);
  changeReferences(document, [&](ElementKind kind, Index& number) {
    if (kind == ElementKind::kNode && number < newIndex.size()) number = newIndex[number];
  });
  if (!renumberDocumentExtensions(document, newIndex)) {
    asset.warnings.add("node-references", "extensions that name nodes by number may now name others");
  }
}

}  // namespace limber
