#include "limber/document/scene/joined_primitive.h"

#include <numeric>

#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/weight_attributes.h"

namespace limber {

namespace {

template <typename T>
std::vector<T> pickRows(const std::vector<T>& values, std::size_t width, const std::vector<Index>& rows) {
  std::vector<T> result;
  result.reserve(rows.size() * width);
  for (const std::size_t row : rows) {
    result.insert(result.end(), values.begin() + row * width, values.begin() + (row + 1) * width);
  }
  return result;
}

template <typename T>
Index addIndices(Asset& asset, const std::vector<Index>& indices, ComponentType type) {
  const std::vector<T> narrow(indices.begin(), indices.end());
  const AccessorInfo info{static_cast<Index>(indices.size()), 1, type, false};
  return addAccessor(asset, info, {reinterpret_cast<const std::uint8_t*>(narrow.data()), narrow.size() * sizeof(T)},
                     kIndexTarget);
}

}  // namespace

gltf::Attributes addJoinedAttributes(Asset& asset, std::span<const VertexAttribute> attributes,
                                     const SkinWeights& weights, Index skinJointCount, const std::vector<Index>& rows) {
  gltf::Attributes result;
  for (const VertexAttribute& attribute : attributes) {
    const std::vector<float> values = pickRows(attribute.values, attribute.components, rows);
    const bool isPosition = attribute.name == "POSITION";
    result.set(attribute.name, addFloatAccessor(asset, values, attribute.components, kVertexTarget, isPosition));
  }
  if (weights.slots == 0) return result;
  SkinWeights kept;
  kept.slots = weights.slots;
  kept.joints = pickRows(weights.joints, weights.slots, rows);
  kept.weights = pickRows(weights.weights, weights.slots, rows);
  PrimitiveInstance range;
  range.vertexCount = kept.vertexCount();
  std::vector<Index> identity(skinJointCount);
  std::iota(identity.begin(), identity.end(), 0);
  for (const auto& [name, accessor] : addWeightAccessors(asset, range, kept, identity, skinJointCount)) {
    result.set(name, accessor);
  }
  return result;
}

Index addJoinedCorners(Asset& asset, std::vector<Index> corners, const JoinedVertices& joined) {
  for (Index& corner : corners) corner = joined.vertex[corner];
  return joined.kept.size() < 0xffff ? addIndices<std::uint16_t>(asset, corners, ComponentType::kU16)
                                     : addIndices<std::uint32_t>(asset, corners, ComponentType::kU32);
}

}  // namespace limber
