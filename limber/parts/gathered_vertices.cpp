#include "limber/parts/gathered_vertices.h"

#include <vector>

#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"
#include "limber/asset/accessor_layout.h"

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

// Attributes of a primitive, or of one morph target.
Json gatherAttributes(Asset& asset, const Json& attributes, std::span<const Index> vertices) {
  Json gathered = Json::object();
  for (const auto& [name, accessor] : attributes.items()) {
    gathered[name] = gatherAccessor(asset, accessor.get<Index>(), vertices, name == "POSITION");
  }
  return gathered;
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

Json gatherVertices(Asset& asset, const Json& primitive, std::span<const Index> vertices) {
  Json gathered = primitive;
  gathered["attributes"] = gatherAttributes(asset, primitive.at("attributes"), vertices);
  if (const auto targets = primitive.find("targets"); targets != primitive.end()) {
    Json moved = Json::array();
    for (const Json& target : *targets) moved.push_back(gatherAttributes(asset, target, vertices));
    gathered["targets"] = std::move(moved);
  }
  gathered.erase("indices");
  return gathered;
}

}  // namespace limber
