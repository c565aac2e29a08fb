#include "limber/pipeline/vertex_colors.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_sweep.h"
#include "limber/asset/json_access.h"

namespace limber {

namespace {

Json& primitiveOf(Asset& asset, const PrimitiveInstance& instance) {
  return asset.json()["meshes"][instance.mesh]["primitives"][instance.primitive];
}

void whiten(Json& material) {
  Json& base = material["pbrMetallicRoughness"];
  if (base.is_null()) base = Json::object();
  base.erase("baseColorTexture");
  if (!base.contains("baseColorFactor")) base["baseColorFactor"] = Json::array({1, 1, 1, 1});
  for (std::size_t channel = 0; channel < 3; ++channel) base["baseColorFactor"][channel] = 1;
}

}  // namespace

void addMissingMaterials(Asset& asset, const Geometry& geometry) {
  std::optional<Index> plain;
  for (const PrimitiveInstance& instance : geometry.instances) {
    if (primitiveOf(asset, instance).contains("material")) continue;
    if (!plain) {
      Json& materials = asset.json()["materials"];
      plain = static_cast<Index>(materials.size());
      // glTF's default would be metal.
      materials.push_back(
          {{"name", "colors"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 1}}}});
    }
    primitiveOf(asset, instance)["material"] = *plain;
  }
}

void setVertexColors(Asset& asset, const Geometry& geometry, std::span<const Vec3f> colors,
                     const std::set<Index>& pictured) {
  if (colors.size() != geometry.positions.size()) {
    throw Error(ErrorCode::kBadArgument, "there is not one colour for each vertex");
  }
  const AccessorSweep unused(asset);
  addMissingMaterials(asset, geometry);
  std::set<std::pair<Index, Index>> done;
  std::set<Index> materials;
  for (const PrimitiveInstance& instance : geometry.instances) {
    if (!done.insert({instance.mesh, instance.primitive}).second) continue;  // shown twice: as at first
    const Index material = primitiveOf(asset, instance)["material"].get<Index>();
    materials.insert(material);
    if (pictured.count(material) > 0) {
      primitiveOf(asset, instance)["attributes"].erase("COLOR_0");
      continue;
    }
    std::vector<float> values;
    for (const Vec3f& color : colors.subspan(instance.firstVertex, instance.vertexCount)) {
      for (int channel = 0; channel < 3; ++channel) values.push_back(std::clamp(color[channel], 0.0f, 1.0f));
      values.push_back(1);
    }
    const Index accessor = addFloatAccessor(asset, values, 4, kVertexTarget);
    primitiveOf(asset, instance)["attributes"]["COLOR_0"] = accessor;
  }
  for (const Index material : materials) whiten(asset.json()["materials"][material]);
  unused.sweep(asset);
}

}  // namespace limber
