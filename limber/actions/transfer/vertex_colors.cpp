#include "limber/actions/transfer/vertex_colors.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_sweep.h"

namespace limber {

namespace {

gltf::Primitive& primitiveOf(Asset& asset, const PrimitiveInstance& instance) {
  return asset.document.meshes[instance.mesh].primitives[instance.primitive];
}

void whiten(gltf::Material& material) {
  if (!material.pbrMetallicRoughness) material.pbrMetallicRoughness.emplace();
  gltf::MetallicRoughness& surface = *material.pbrMetallicRoughness;
  surface.baseColorTexture.reset();
  if (!surface.baseColorFactor) surface.baseColorFactor = Vec4::Ones();
  surface.baseColorFactor->head<3>().setOnes();
}

}  // namespace

void addMissingMaterials(Asset& asset, const Geometry& geometry) {
  std::optional<Index> plain;
  for (const PrimitiveInstance& instance : geometry.instances) {
    gltf::Primitive& primitive = primitiveOf(asset, instance);
    if (primitive.material) continue;
    if (!plain) {
      gltf::Material material;
      material.name = "colors";
      material.pbrMetallicRoughness.emplace().metallicFactor = 0;  // glTF's default would be metal
      plain = addElement(asset.document.materials, std::move(material));
    }
    primitive.material = plain;
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
    gltf::Primitive& primitive = primitiveOf(asset, instance);
    const Index material = *primitive.material;
    materials.insert(material);
    if (pictured.count(material) > 0) {
      primitive.attributes.erase("COLOR_0");
      continue;
    }
    std::vector<float> values;
    for (const Vec3f& color : colors.subspan(instance.firstVertex, instance.vertexCount)) {
      for (int channel = 0; channel < 3; ++channel) values.push_back(std::clamp(color[channel], 0.0f, 1.0f));
      values.push_back(1);
    }
    primitive.attributes.set("COLOR_0", addFloatAccessor(asset, values, 4, kVertexTarget));
  }
  for (const Index material : materials) whiten(asset.document.materials[material]);
  unused.sweep(asset);
}

}  // namespace limber
