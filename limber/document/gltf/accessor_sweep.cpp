#include "limber/document/gltf/accessor_sweep.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "limber/document/gltf/references.h"

namespace limber {

namespace {

// Extensions of primitives, nodes, skins, animations and the document that name no accessor, or whose accessors are
// followed here.
constexpr std::array<std::string_view, 19> kTransparent = {"EXT_mesh_gpu_instancing",
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
                                                           "VRMC_node_constraint",
                                                           "VRMC_springBone",
                                                           "VRMC_vrm_animation"};

bool transparent(const gltf::Object& object) {
  if (!object.extensions.exists()) return true;
  const auto& all = object.extensions->items();
  return std::all_of(all.begin(), all.end(), [](const auto& extension) {
    return std::find(kTransparent.begin(), kTransparent.end(), extension.key()) != kTransparent.end();
  });
}

template <typename Element>
bool allTransparent(const std::vector<Element>& list) {
  return std::all_of(list.begin(), list.end(), [](const Element& element) { return transparent(element); });
}

bool understood(const gltf::Document& document) {
  return transparent(document) && allTransparent(document.meshes) && allTransparent(document.nodes) &&
         allTransparent(document.skins) && allTransparent(document.animations) && allTransparent(document.scenes) &&
         std::all_of(document.meshes.begin(), document.meshes.end(),
                     [](const gltf::Mesh& mesh) { return allTransparent(mesh.primitives); });
}

std::vector<bool> usedAccessors(const gltf::Document& document) {
  std::vector<bool> used(document.accessors.size(), false);
  visitReferences(document, [&](ElementKind kind, Index number) {
    if (kind == ElementKind::kAccessor && number < used.size()) used[number] = true;
  });
  return used;
}

}  // namespace

AccessorSweep::AccessorSweep(const Asset& asset) : usedBefore_(usedAccessors(asset.document)) {}

void AccessorSweep::sweep(Asset& asset) const {
  gltf::Document& document = asset.document;
  const std::vector<bool> used = usedAccessors(document);
  const auto count = static_cast<Index>(used.size());
  const auto countBefore = static_cast<Index>(usedBefore_.size());
  // The accessor in each slot of the new list. New accessors fill the slots that became free, so that as few numbers as
  // possible change: none of the old ones, unless the edit removes more than it adds.
  std::vector<std::optional<Index>> slots(countBefore);
  for (Index a = 0; a < countBefore; ++a) {
    if (used[a] || !usedBefore_[a]) slots[a] = a;
  }
  Index hole = 0;
  for (Index a = countBefore; a < count; ++a) {
    while (hole < countBefore && slots[hole]) ++hole;
    if (hole < countBefore) {
      slots[hole] = a;
    } else {
      slots.emplace_back(a);
    }
  }
  slots.erase(std::remove(slots.begin(), slots.end(), std::nullopt), slots.end());
  if (slots.size() == used.size() || !understood(document)) return;

  std::vector<gltf::Accessor> kept;
  std::vector<Index> newIndex(count, kNoIndex);
  for (const std::optional<Index>& a : slots) newIndex[*a] = addElement(kept, std::move(document.accessors[*a]));
  document.accessors = std::move(kept);
  changeReferences(document, [&](ElementKind kind, Index& number) {
    if (kind == ElementKind::kAccessor && number < count) number = newIndex[number];
  });
}

}  // namespace limber
