#include "limber/document/gltf/extensions.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

// What limber follows itself, and what only says how a surface is lit or described.
bool isHarmless(std::string_view name) {
  constexpr std::string_view kFollowed[] = {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
                                            "KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                            "KHR_meshopt_compression"};
  constexpr std::string_view kLooks[] = {"KHR_materials_", "EXT_materials_", "KHR_texture_", "EXT_texture_",
                                         "MSFT_texture_",  "KHR_lights_",    "EXT_lights_",  "KHR_xmp"};
  const auto begins = [&](std::string_view start) { return name.substr(0, start.size()) == start; };
  return std::find(std::begin(kFollowed), std::end(kFollowed), name) != std::end(kFollowed) ||
         std::any_of(std::begin(kLooks), std::end(kLooks), begins);
}

}  // namespace

const Json* extensionOf(const gltf::Object& owner, const char* name) {
  return owner.extensions.exists() ? member(*owner.extensions, name) : nullptr;
}

Json& changeExtension(gltf::Object& owner, const char* name) {
  Json& content = owner.extensions.change()[name];
  if (content.is_null()) content = Json::object();
  return content;
}

bool eraseExtension(gltf::Object& owner, const char* name) {
  if (extensionOf(owner, name) == nullptr) return false;
  owner.extensions.change().erase(name);
  if (owner.extensions->empty()) owner.extensions.reset();
  return true;
}

void declareExtension(gltf::Document& document, std::string_view name) {
  std::vector<std::string>& used = document.extensionsUsed;
  if (std::find(used.begin(), used.end(), name) == used.end()) used.emplace_back(name);
}

void undeclareExtension(gltf::Document& document, std::string_view name) {
  std::erase(document.extensionsUsed, name);
  std::erase(document.extensionsRequired, name);
}

gltf::Attributes instancingOf(const gltf::Node& node, std::string_view location) {
  const Json* content = extensionOf(node, kInstancingName);
  if (content == nullptr) return {};
  const std::string path = std::string(location) + ".extensions." + kInstancingName;
  std::vector<std::pair<std::string, Index>> list;
  JsonView(content, path).object("attributes").forEachMember([&](std::string_view name, const JsonView& accessor) {
    list.emplace_back(name, accessor.asIndex(kNoIndex));
  });
  return gltf::Attributes(std::move(list));
}

const std::string* animationPointer(const gltf::AnimationChannel::Target& target) {
  const Json* extension = extensionOf(target, kPointerName);
  const Json* pointer = extension != nullptr ? member(*extension, "pointer") : nullptr;
  return pointer != nullptr ? pointer->get_ptr<const std::string*>() : nullptr;
}

void setAnimationPointer(gltf::AnimationChannel::Target& target, std::string_view pointer) {
  changeExtension(target, kPointerName)["pointer"] = pointer;
}

void warnOfUnknownExtensions(Asset& asset) {
  for (const std::string& name : asset.document.extensionsRequired) {
    if (isHarmless(name)) continue;
    asset.warnings.add("unknown-extensions",
                       "extensions that the file requires are unknown to limber and stay as they are", name);
  }
}

}  // namespace limber
