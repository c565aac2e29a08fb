// A body laid on another one as a whole, and how near two surfaces lie to each other.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/rigging/transfer/limb_alignment.h"

namespace limber {

// How far the triangles of a mesh reach along a unit vector, from one end to the other; -infinity where it has none.
double extentAlong(const TriMesh& mesh, const Vec3& axis);

// The similarity that brings `source` onto `target`: turned by `turn`, as high along the target's `up` and with its box
// on the target's; from there by iterative closest points, with normals that agree (Besl, McKay 1992; with scale).
// Where these shrink or grow it by more than a quarter, as surfaces that do not match make them do, it stays as at
// first. Both facing outwards, with triangles. Cost: O((#V + #T) log #F), of at most 2000 vertices of each.
Affine wholeSimilarity(const TriMesh& source, const TriMesh& target, const Quat& turn, const Vec3& up);

// The alignment that moves everything by one similarity.
LimbAlignment alignWhole(std::span<const Affine> globals, const Affine& similarity);

// The distance between the surfaces, in both directions, as the root of the mean square over at most 2000 vertices of
// each, to the nearest point that faces about the same direction; from a tenth of the target's longest side on a vertex
// counts as that. Parts of the target's longest side.
double surfacesApart(const TriMesh& source, const TriMesh& target);

}  // namespace limber
