// A mesh as a document.
#pragma once

#include <string>

#include "limber/document/asset.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// With one node that shows the mesh, both of that name; positions and triangles alone, in their order.
Asset meshAsset(const TriMesh& mesh, const std::string& name = "model");

}  // namespace limber
