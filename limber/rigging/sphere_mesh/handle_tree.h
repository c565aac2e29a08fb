// From spheres and their neighbourhoods to a tree of handles.
#pragma once

#include <optional>
#include <vector>

#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber {

// Handles in the order of the joints: the root first, parents before children, wide branches before thin ones, a handle
// before its mirror image.
struct HandleTree {
  std::vector<Index> order;                   // joint -> handle of the level
  std::vector<std::optional<Index>> parents;  // per joint: the parent's joint; none for the root alone
};

// A spanning tree of the level's edges that prefers short links between thick spheres, rooted at the most central
// sphere: the one with the least sum of distances along the tree to all others, each weighted by its volume. On a
// symmetric level the tree is its own mirror image: the spheres on the plane hang together, and the root is one of
// them; only where none is on the plane the root is one of a pair, and its image hangs on it. Cost: O(#H log #H).
HandleTree handleTree(const SphereMeshLevel& level);

}  // namespace limber
