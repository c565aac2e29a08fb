#include "limber/actions/parts/part_triangles.h"

#include <algorithm>
#include <map>

#include "limber/document/gltf/accessor.h"

namespace limber {

namespace {

template <typename T>
Index addIndices(Asset& asset, const std::vector<Triangle>& triangles, ComponentType type) {
  std::vector<T> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    for (const Index v : triangle) corners.push_back(static_cast<T>(v));
  }
  return addAccessor(asset, {static_cast<Index>(corners.size()), 1, type, false},
                     {reinterpret_cast<const std::uint8_t*>(corners.data()), corners.size() * sizeof(T)}, kIndexTarget);
}

}  // namespace

std::vector<std::vector<PartTriangles>> partTriangles(const Geometry& geometry, const SurfaceParts& parts) {
  std::vector<std::vector<PartTriangles>> result(geometry.instances.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const PrimitiveInstance& instance = geometry.instances[i];
    const bool mirrored = instance.toWorld.linear().determinant() < 0;
    const Index end = instance.firstVertex + instance.vertexCount;
    std::map<Index, std::vector<Triangle>> byPart;
    for (; next < geometry.triangles.size(); ++next) {
      Triangle t = geometry.triangles[next];
      if (t[0] < instance.firstVertex || t[0] >= end) break;
      if (mirrored) std::swap(t[1], t[2]);
      for (Index& v : t) v -= instance.firstVertex;
      byPart[parts.partOf[next]].push_back(t);
    }
    for (auto& [part, triangles] : byPart) result[i].push_back({part, std::move(triangles)});
  }
  return result;
}

Index addTriangleAccessor(Asset& asset, const std::vector<Triangle>& triangles, Index vertexCount) {
  // The largest number of each width means a restart of strips.
  if (vertexCount <= 65535) return addIndices<std::uint16_t>(asset, triangles, ComponentType::kU16);
  return addIndices<std::uint32_t>(asset, triangles, ComponentType::kU32);
}

}  // namespace limber
