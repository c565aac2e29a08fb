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

// A spanning tree of the level's edges that prefers long borders between thick parts that are near each other, as a
// current would: a leg meets the pelvis rather than the belly's fold beside it; between pieces that are apart short
// gaps, as everywhere where the level has no borders. It is rooted at the most central sphere: the one with the least
// sum of distances along the tree to all others, each weighted by its volume, and to the tips of the tree, all of which
// together weigh 0.3 of the volume. On a symmetric level the tree is its own mirror image: spheres on the plane are
// joined to each other, those that meet through a pair alone too, and the root is one of them; only where none is on
// the plane the root is one of a pair, and its image is its child. Cost: O(#H log #H).
HandleTree handleTree(const SphereMeshLevel& level);

}  // namespace limber
