// Vertex data of some of a primitive's vertices.
#pragma once

#include <span>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// A new accessor with these elements of another, in their order, of the same type; as floats where elements do not fill
// whole words of four bytes, which glTF asks of vertices. `withBounds`: with min and max, as for positions.
Index gatherAccessor(Asset& asset, Index accessor, std::span<const Index> elements, bool withBounds);

// A primitive with its attributes and morph targets gathered, without indices.
gltf::Primitive gatherVertices(Asset& asset, gltf::Primitive primitive, std::span<const Index> vertices);

}  // namespace limber
