// The triangles of one primitive.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// The corners of its triangles, as indices into its own vertices, of which there are `vertexCount`; strips and fans
// become triangles, points and lines give none.
std::vector<Triangle> primitiveTriangles(const Asset& asset, const gltf::Primitive& primitive, Index vertexCount);

}  // namespace limber
