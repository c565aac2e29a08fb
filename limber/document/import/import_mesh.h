// One Assimp mesh as glTF primitives.
#pragma once

#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/skeleton/skin_weights.h"

struct aiMesh;

namespace limber {

// Appends the mesh's accessors to the asset and returns the primitives: triangles, and separately lines and points
// where it has such. Corners with the same attributes, to the bit, become one vertex (in the order first met);
// positions are multiplied by `scale`. `weights` are those of the mesh's vertices over the joints of its skin; none (no
// slots) for a mesh without a skin. Throws Error kBadData for a position that is not finite or an index out of range.
// Repairs (normals of length 0, attributes that are not finite) are counted in the asset's warnings.
std::vector<gltf::Primitive> importPrimitives(Asset& asset, const aiMesh& mesh, double scale,
                                              const SkinWeights& weights, Index skinJointCount);

}  // namespace limber
