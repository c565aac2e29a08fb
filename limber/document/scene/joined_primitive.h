// Joined vertices as the accessors of a primitive.
#pragma once

#include <span>
#include <vector>

#include "limber/document/asset.h"
#include "limber/document/mesh/vertex_join.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// The given rows of all attributes, and of the weights as JOINTS_n and WEIGHTS_n where these have slots.
gltf::Attributes addJoinedAttributes(Asset& asset, std::span<const VertexAttribute> attributes,
                                     const SkinWeights& weights, Index skinJointCount, const std::vector<Index>& rows);

// Indices for a list of corners, each a row that was joined; 16 bits wide where that is enough.
Index addJoinedCorners(Asset& asset, std::vector<Index> corners, const JoinedVertices& joined);

}  // namespace limber
