#include "limber/document/scene/texture_coordinates.h"

#include "limber/document/gltf/accessor.h"

namespace limber {

std::vector<Vec2f> readUvs(const Asset& asset, const PrimitiveInstance& instance) {
  const gltf::Primitive& primitive = asset.document.meshes[instance.mesh].primitives[instance.primitive];
  const std::optional<Index> accessor = primitive.attributes.find("TEXCOORD_0");
  const std::vector<float> values = accessor ? readFloats(asset, *accessor) : std::vector<float>();
  std::vector<Vec2f> uvs;
  if (values.size() != 2 * std::size_t{instance.vertexCount}) return uvs;
  for (std::size_t v = 0; v < instance.vertexCount; ++v) uvs.emplace_back(values[2 * v], values[2 * v + 1]);
  return uvs;
}

}  // namespace limber
