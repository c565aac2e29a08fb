#include "limber/asset/extensions.h"

#include <algorithm>
#include <string_view>

#include <nlohmann/json.hpp>

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

JsonView extensionOf(const JsonView& owner, const char* name) {
  return owner.object("extensions").object(name);
}

bool eraseExtension(Json& owner, const char* name) {
  const auto extensions = owner.find("extensions");
  if (extensions == owner.end() || extensions->erase(name) == 0) return false;
  if (extensions->empty()) owner.erase("extensions");
  return true;
}

void undeclareExtension(Json& document, const char* name) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    const auto names = document.find(list);
    if (names == document.end()) continue;
    names->erase(std::remove(names->begin(), names->end(), name), names->end());
    if (names->empty()) document.erase(list);
  }
}

void warnOfUnknownExtensions(Asset& asset) {
  const JsonView required = JsonView(asset).array("extensionsRequired");
  for (std::size_t i = 0; i < required.size(); ++i) {
    if (!required[i].json().is_string()) continue;
    const std::string& name = required[i].json().get_ref<const std::string&>();
    if (isHarmless(name)) continue;
    asset.warnings.add("unknown-extensions",
                       "extensions that the file requires are unknown to limber and stay as they are", name);
  }
}

}  // namespace limber
