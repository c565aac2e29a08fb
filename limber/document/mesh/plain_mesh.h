// A mesh of another format, read into plain arrays, as glTF primitives.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/mesh/vertex_join.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Rows of all attributes and of `weights` belong to the same vertices; corners are rows.
struct PlainMesh {
  std::string name;                           // for warnings
  std::vector<VertexAttribute> attributes;    // POSITION first; normals of any length
  std::array<std::vector<Index>, 3> corners;  // of points, lines, triangles
  SkinWeights weights;                        // no slots for a mesh without a skin
  Index skinJointCount = 0;
};

// Appends the mesh's accessors to the asset and returns the primitives: triangles, and separately lines and points
// where it has such; points alone where it has no corners. Rows with the same attributes, to the bit, become one vertex
// (in the order first met). Throws Error kBadData for a position that is not finite. Repairs (normals of length 0,
// attributes that are not finite) are counted in the asset's warnings.
std::vector<gltf::Primitive> addPlainMesh(Asset& asset, PlainMesh mesh);

}  // namespace limber
