#include "limber/document/scene/primitive_triangles.h"

#include "limber/document/gltf/accessor.h"

namespace limber {

std::vector<Triangle> primitiveTriangles(const Asset& asset, const gltf::Primitive& primitive, Index vertexCount) {
  const Index mode = primitive.mode;
  if (mode != gltf::kTriangles && mode != gltf::kTriangleStrip && mode != gltf::kTriangleFan) return {};

  const std::optional<Index> accessor = primitive.indices;
  const std::vector<Index> indices = accessor ? readIndices(asset, *accessor) : std::vector<Index>();
  const std::size_t corners = accessor ? indices.size() : vertexCount;
  const auto corner = [&](std::size_t i) { return accessor ? indices[i] : static_cast<Index>(i); };

  std::vector<Triangle> triangles;
  if (mode == gltf::kTriangles) {
    triangles.reserve(corners / 3);
    for (std::size_t i = 0; i + 2 < corners; i += 3) triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  } else if (mode == gltf::kTriangleStrip) {
    for (std::size_t i = 0; i + 2 < corners; ++i) {
      triangles.push_back({corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)});
    }
  } else {
    for (std::size_t i = 1; i + 1 < corners; ++i) triangles.push_back({corner(0), corner(i), corner(i + 1)});
  }
  return triangles;
}

}  // namespace limber
