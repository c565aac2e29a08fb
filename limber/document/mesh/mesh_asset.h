// A mesh as a document.
#pragma once

#include "limber/document/asset.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// With one node, "model", that shows the mesh; positions and triangles alone, in their order.
Asset meshAsset(const TriMesh& mesh);

}  // namespace limber
