#include "limber/asset/node_edit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/extensions.h"
#include "limber/asset/scene_graph.h"
#include "limber/core/transform.h"

namespace limber {

double shortDouble(double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) throw Error(ErrorCode::kBadData, "a node lies beyond what single precision can hold");
  return Json::parse(fmt::format("{}", single)).get<double>();
}

void setNodeTransform(Json& node, const Affine& local, bool mayHaveMatrix) {
  for (const char* key : {"matrix", "translation", "rotation", "scale"}) node.erase(key);
  bool sheared = false;
  const Transform t = decompose(local, &sheared);
  const auto numbers = [](const double* values, int count) {
    Json result = Json::array();
    for (int i = 0; i < count; ++i) result.push_back(shortDouble(values[i]));
    return result;
  };
  if (sheared && mayHaveMatrix) {
    node["matrix"] = numbers(local.matrix().data(), 16);
    return;
  }
  if (t.translation != Vec3::Zero()) node["translation"] = numbers(t.translation.data(), 3);
  if (t.rotation.coeffs() != Quat::Identity().coeffs()) node["rotation"] = numbers(t.rotation.coeffs().data(), 4);
  if (t.scale != Vec3::Ones()) node["scale"] = numbers(t.scale.data(), 3);
}

namespace {

constexpr std::string_view kPointerStart = "/nodes/";

// The pointer of KHR_animation_pointer, null where the target has none.
template <typename AnyJson>
AnyJson* pointerOf(AnyJson& target) {
  const auto extensions = target.find("extensions");
  if (extensions == target.end()) return nullptr;
  const auto extension = extensions->find("KHR_animation_pointer");
  if (extension == extensions->end()) return nullptr;
  const auto pointer = extension->find("pointer");
  return pointer != extension->end() && pointer->is_string() ? &*pointer : nullptr;
}

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

void renumberTarget(Json& channel, const std::vector<Index>& newIndex) {
  const ChannelTarget named = channelTarget(channel);
  if (!named.node || *named.node >= newIndex.size()) return;
  Json& target = channel["target"];
  if (Json* pointer = pointerOf(target)) {
    *pointer = fmt::format("{}{}/{}", kPointerStart, newIndex[*named.node], named.path);
  } else {
    target["node"] = newIndex[*named.node];
  }
}

// Takes the samplers out that no channel of the animation names, and renumbers the others.
void removeUnusedSamplers(Json& animation) {
  const auto samplers = animation.find("samplers");
  if (samplers == animation.end()) return;
  std::vector<Index> newIndex(samplers->size(), kNoIndex);
  for (const Json& channel : animation["channels"]) {
    if (const auto sampler = indexMember(channel, "sampler")) newIndex.at(*sampler) = 0;
  }
  Json kept = Json::array();
  for (Index s = 0; s < newIndex.size(); ++s) {
    if (newIndex[s] == kNoIndex) continue;
    newIndex[s] = static_cast<Index>(kept.size());
    kept.push_back(std::move((*samplers)[s]));
  }
  for (Json& channel : animation["channels"]) {
    if (const auto sampler = indexMember(channel, "sampler")) channel["sampler"] = newIndex[*sampler];
  }
  *samplers = std::move(kept);
}

// The elements of a list of nodes that are kept, under their new numbers; the key goes where none is.
void renumberList(Json& object, const char* key, const std::vector<Index>& newIndex) {
  const auto list = object.find(key);
  if (list == object.end() || !list->is_array()) return;
  Json kept = Json::array();
  for (const Json& element : *list) {
    const Index node = newIndex.at(element.get<Index>());
    if (node != kNoIndex) kept.push_back(node);
  }
  if (kept.empty()) {
    object.erase(key);
  } else {
    *list = std::move(kept);
  }
}

// Renumbers the nodes of VRMC_springBone's springs: those of deleted joints go, and the extension where none is left.
// False where colliders hang on deleted nodes: these are kept as they are.
bool renumberSprings(Json& document, const std::vector<Index>& newIndex) {
  Json& extension = document["extensions"][kSpringBoneName];
  const auto isKept = [&](const Json& holder, const char* key) {
    const std::optional<Index> node = holder.is_object() ? indexMember(holder, key) : std::nullopt;
    return node && *node < newIndex.size() && newIndex[*node] != kNoIndex;
  };
  Json kept = Json::array();
  for (Json& spring : extension["springs"]) {
    if (!spring.is_object()) continue;
    Json& joints = spring["joints"];
    if (!joints.is_array() ||
        !std::all_of(joints.begin(), joints.end(), [&](const Json& joint) { return isKept(joint, "node"); })) {
      continue;
    }
    for (Json& joint : joints) joint["node"] = newIndex[joint["node"].get<Index>()];
    if (isKept(spring, "center")) {
      spring["center"] = newIndex[spring["center"].get<Index>()];
    } else {
      spring.erase("center");
    }
    kept.push_back(std::move(spring));
  }
  if (kept.empty()) {
    eraseExtension(document, kSpringBoneName);
    undeclareExtension(document, kSpringBoneName);
    return true;
  }
  extension["springs"] = std::move(kept);
  const auto colliders = extension.find("colliders");
  if (colliders == extension.end() || !colliders->is_array()) return true;
  bool allKept = true;
  for (Json& collider : *colliders) {
    if (isKept(collider, "node")) {
      collider["node"] = newIndex[collider["node"].get<Index>()];
    } else {
      allKept = false;
    }
  }
  return allKept;
}

// Does anything in there look like the number of a node?
bool seemsToNameNodes(const Json& value) {
  if (value.is_object()) {
    for (const auto& [key, inner] : value.items()) {
      if ((key == "node" || key == "nodes" || key == "bone" || key == "bones") && !inner.is_object()) return true;
      if (seemsToNameNodes(inner)) return true;
    }
  } else if (value.is_array()) {
    return std::any_of(value.begin(), value.end(), seemsToNameNodes);
  }
  return false;
}

}  // namespace

ChannelTarget channelTarget(const Json& channel) {
  const Json* target = member(channel, "target");
  if (!target) return {};
  if (const Json* pointer = pointerOf(*target)) return parsePointer(pointer->get<std::string>());
  const Json* path = member(*target, "path");
  return {indexMember(*target, "node"), path && path->is_string() ? path->get<std::string>() : std::string()};
}

void removeChannels(Asset& asset, const std::function<bool(Index, std::string_view)>& drop) {
  const auto animations = asset.json().find("animations");
  if (animations == asset.json().end()) return;
  Json kept = Json::array();
  for (Json& animation : *animations) {
    Json channels = Json::array();
    for (Json& channel : animation["channels"]) {
      const ChannelTarget target = channelTarget(channel);
      if (!target.node || !drop(*target.node, target.path)) channels.push_back(channel);
    }
    if (channels.size() != animation["channels"].size()) {
      if (channels.empty()) continue;
      animation["channels"] = std::move(channels);
      removeUnusedSamplers(animation);
    }
    kept.push_back(std::move(animation));
  }
  if (kept.empty()) {
    asset.json().erase("animations");
  } else {
    *animations = std::move(kept);
  }
}

void retargetMorphChannels(Asset& asset, Index from, Index to) {
  const auto animations = asset.json().find("animations");
  if (animations == asset.json().end()) return;
  std::vector<Index> newIndex(elementCount(asset, "nodes"));
  for (Index n = 0; n < newIndex.size(); ++n) newIndex[n] = n == from ? to : n;
  for (Json& animation : *animations) {
    for (Json& channel : animation["channels"]) {
      const ChannelTarget target = channelTarget(channel);
      if (target.node == from && target.path.rfind("weights", 0) == 0) renumberTarget(channel, newIndex);
    }
  }
}

void deleteNodes(Asset& asset, const std::vector<bool>& keep) {
  if (std::find(keep.begin(), keep.end(), false) == keep.end()) return;
  removeChannels(asset, [&](Index node, std::string_view) { return node < keep.size() && !keep[node]; });

  std::vector<Index> newIndex(keep.size(), kNoIndex);
  Json kept = Json::array();
  Json& json = asset.json();
  for (Index n = 0; n < keep.size(); ++n) {
    if (!keep[n]) continue;
    newIndex[n] = static_cast<Index>(kept.size());
    kept.push_back(std::move(json["nodes"][n]));
  }
  for (Json& node : kept) {
    renumberList(node, "children", newIndex);
    const auto extensions = node.find("extensions");
    if (extensions == node.end()) continue;
    const auto lod = extensions->find("MSFT_lod");
    if (lod != extensions->end() && lod->is_object()) renumberList(*lod, "ids", newIndex);
  }
  if (kept.empty()) {
    json.erase("nodes");
  } else {
    json["nodes"] = std::move(kept);
  }

  for (const char* kind : {"scenes", "skins", "animations"}) {
    const auto list = json.find(kind);
    if (list == json.end()) continue;
    for (Json& element : *list) {
      renumberList(element, "nodes", newIndex);
      renumberList(element, "joints", newIndex);
      if (const auto root = indexMember(element, "skeleton")) element["skeleton"] = newIndex[*root];
      const auto channels = element.find("channels");
      if (channels == element.end()) continue;
      for (Json& channel : *channels) renumberTarget(channel, newIndex);
    }
  }
  Json others = json.value("extensions", Json::object());
  const bool hasSprings = others.is_object() && others.contains(kSpringBoneName) && others[kSpringBoneName].is_object();
  if (hasSprings) others.erase(kSpringBoneName);
  if ((hasSprings && !renumberSprings(json, newIndex)) || seemsToNameNodes(others)) {
    asset.warnings.add("node-references", "extensions that name nodes by number may now name others");
  }
}

}  // namespace limber
