#include "limber/asset/accessor_sweep.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "limber/asset/scene_graph.h"

namespace limber {

namespace {

// Extensions of primitives, nodes, skins, animations and the document that name no accessor, or whose accessors are
// followed here.
constexpr std::array<std::string_view, 17> kTransparent = {"EXT_mesh_gpu_instancing",
                                                           "KHR_animation_pointer",
                                                           "KHR_draco_mesh_compression",
                                                           "KHR_lights_punctual",
                                                           "KHR_materials_variants",
                                                           "KHR_mesh_quantization",
                                                           "KHR_node_hoverability",
                                                           "KHR_node_selectability",
                                                           "KHR_node_visibility",
                                                           "KHR_xmp",
                                                           "KHR_xmp_json_ld",
                                                           "MSFT_lod",
                                                           "EXT_lights_ies",
                                                           "EXT_lights_image_based",
                                                           "VRM",
                                                           "VRMC_vrm",
                                                           "VRMC_springBone"};

bool transparent(const Json& object) {
  const Json* extensions = member(object, "extensions");
  if (!extensions || !extensions->is_object()) return true;
  for (const auto& [name, content] : extensions->items()) {
    if (std::find(kTransparent.begin(), kTransparent.end(), name) == kTransparent.end()) return false;
  }
  return true;
}

// Visits everything that holds the number of an accessor; works on const and changeable documents alike.
template <typename Document, typename Visit>
void visitMembers(Document& object, const char* key, const Visit& visit) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_object()) return;
  for (auto& value : *found) visit(value);
}

template <typename Document, typename Visit>
void visitMember(Document& object, const char* key, const Visit& visit) {
  const auto found = object.find(key);
  if (found != object.end()) visit(*found);
}

template <typename Document, typename Visit>
void visitElements(Document& object, const char* key, const Visit& visit) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_array()) return;
  for (auto& element : *found) visit(element);
}

template <typename Document, typename Visit>
void visitAccessors(Document& json, const Visit& visit) {
  visitElements(json, "meshes", [&](auto& mesh) {
    visitElements(mesh, "primitives", [&](auto& primitive) {
      visitMembers(primitive, "attributes", visit);
      visitMember(primitive, "indices", visit);
      visitElements(primitive, "targets", [&](auto& target) {
        for (auto& accessor : target) visit(accessor);
      });
    });
  });
  visitElements(json, "skins", [&](auto& skin) { visitMember(skin, "inverseBindMatrices", visit); });
  visitElements(json, "animations", [&](auto& animation) {
    visitElements(animation, "samplers", [&](auto& sampler) {
      visitMember(sampler, "input", visit);
      visitMember(sampler, "output", visit);
    });
  });
  visitElements(json, "nodes", [&](auto& node) {
    visitMember(node, "extensions", [&](auto& extensions) {
      visitMember(extensions, "EXT_mesh_gpu_instancing",
                  [&](auto& instancing) { visitMembers(instancing, "attributes", visit); });
    });
  });
}

std::vector<bool> usedAccessors(const Asset& asset) {
  std::vector<bool> used(elementCount(asset, "accessors"), false);
  visitAccessors(asset.json(), [&](const Json& accessor) {
    const auto index = accessor.get<std::size_t>();
    if (index < used.size()) used[index] = true;
  });
  return used;
}

bool understood(const Json& json) {
  bool result = transparent(json);
  const auto look = [&](const Json& element) { result = result && transparent(element); };
  for (const char* kind : {"meshes", "nodes", "skins", "animations", "scenes"}) visitElements(json, kind, look);
  visitElements(json, "meshes", [&](const Json& mesh) { visitElements(mesh, "primitives", look); });
  return result;
}

}  // namespace

AccessorSweep::AccessorSweep(const Asset& asset) : usedBefore_(usedAccessors(asset)) {}

void AccessorSweep::sweep(Asset& asset) const {
  const std::vector<bool> used = usedAccessors(asset);
  const auto count = static_cast<Index>(used.size());
  const auto countBefore = static_cast<Index>(usedBefore_.size());
  // What stands at each place of the new list. New accessors fill the places that became free, so that as few numbers
  // as possible change: none that was there before, unless the edit takes out more than it adds.
  std::vector<std::optional<Index>> places(countBefore);
  for (Index a = 0; a < countBefore; ++a) {
    if (used[a] || !usedBefore_[a]) places[a] = a;
  }
  Index hole = 0;
  for (Index a = countBefore; a < count; ++a) {
    while (hole < countBefore && places[hole]) ++hole;
    if (hole < countBefore) {
      places[hole] = a;
    } else {
      places.emplace_back(a);
    }
  }
  places.erase(std::remove(places.begin(), places.end(), std::nullopt), places.end());
  if (places.size() == used.size() || !understood(asset.json())) return;

  Json& accessors = asset.json()["accessors"];
  Json list = Json::array();
  std::vector<Index> newIndex(count, kNoIndex);
  for (const std::optional<Index>& a : places) {
    newIndex[*a] = static_cast<Index>(list.size());
    list.push_back(std::move(accessors[*a]));
  }
  accessors = std::move(list);
  visitAccessors(asset.json(), [&](Json& accessor) { accessor = newIndex.at(accessor.get<std::size_t>()); });
}

}  // namespace limber
