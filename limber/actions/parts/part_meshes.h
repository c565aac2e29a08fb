// A document taken apart: each part a mesh of its own, closed where it was cut.
#pragma once

#include <string>
#include <vector>

#include "limber/actions/parts/fuzzy_cut.h"
#include "limber/core/progress.h"
#include "limber/document/scene/geometry.h"

namespace limber {

struct SplitOptions {
  bool caps = true;  // close the cuts (capParts)
};

// The nodes that show a part, after splitting.
struct PartNodes {
  std::string name;
  std::vector<Index> nodes;
};

// Replaces each mesh that a node of the scene shows by one for each part that it has triangles of, on a node named
// after the part ("head", or "head_part" where a node has that name already), with the vertices that the part uses: all
// attributes, morph targets and weights go along, and skins. Without a skin the new nodes are children of the one that
// had the mesh, and move with it. Meshes of one skin that have no morph targets become one for each part, on nodes at
// the scenes' roots, as glTF requires of skinned ones; nodes that are then empty are removed. Caps are primitives of
// their own, with a material named "cut", flat normals, weights as at the vertices round them, no texture coordinates.
//
// geometry  collectGeometry(asset) as it is; `parts` one for each of its triangles
// Warning "open-cuts": edges of cuts that no cap closes, since the surface is open there, or the cut runs between two
// nodes. Primitives other than triangles stay where they are. Throws Error kUnsupported where GPU instances show a
// mesh, kCancelled. Cost: O(#F log #F + #parts #S).
std::vector<PartNodes> splitParts(Asset& asset, const Geometry& geometry, const SurfaceParts& parts,
                                  const SplitOptions& options, Progress& progress);

}  // namespace limber
