#include "limber/actions/parts/gathered_vertices.h"

#include <vector>

#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_layout.h"

namespace limber {

namespace {

constexpr std::size_t kWord = 4;

template <typename T>
Index addGathered(Asset& asset, const AccessorInfo& info, const std::vector<T>& all, std::span<const Index> elements) {
  std::vector<T> values;
  values.reserve(elements.size() * info.components);
  for (const Index element : elements) {
    const auto at = all.begin() + static_cast<std::ptrdiff_t>(std::size_t{element} * info.components);
    values.insert(values.end(), at, at + info.components);
  }
  return addAccessor(asset, info, {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)},
                     kVertexTarget);
}

// Of a primitive, or of one morph target.
void gatherAttributes(Asset& asset, gltf::Attributes& attributes, std::span<const Index> vertices) {
  for (auto& [name, accessor] : attributes) accessor = gatherAccessor(asset, accessor, vertices, name == "POSITION");
}

}  // namespace

Index gatherAccessor(Asset& asset, Index accessor, std::span<const Index> elements, bool withBounds) {
  AccessorInfo info = accessorInfo(asset, accessor);
  info.count = static_cast<Index>(elements.size());
  const AccessorLayout layout = accessorLayout(asset, accessor);
  Index added = 0;
  if (info.components * layout.componentBytes % kWord != 0 || layout.columns > 1) {
    const std::vector<float> all = readFloats(asset, accessor);
    added = addGathered(asset, {info.count, info.components, ComponentType::kF32, false}, all, elements);
  } else {
    added = withComponentType(info.type, [&](auto zero) {
      using T = decltype(zero);
      std::vector<T> all(std::size_t{layout.info.count} * info.components);
      readElements<T>(
          layout, [](T value) { return value; }, all);
      return addGathered(asset, info, all, elements);
    });
  }
  if (withBounds) setBounds(asset, added);
  return added;
}

gltf::Primitive gatherVertices(Asset& asset, gltf::Primitive primitive, std::span<const Index> vertices) {
  gatherAttributes(asset, primitive.attributes, vertices);
  for (gltf::Attributes& target : primitive.targets) gatherAttributes(asset, target, vertices);
  primitive.indices.reset();
  return primitive;
}

}  // namespace limber
