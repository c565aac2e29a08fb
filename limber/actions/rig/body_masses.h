// How heavy a body is, and where.
#pragma once

#include <vector>

#include "limber/document/scene/geometry.h"
#include "limber/skeleton/ik/ik_task.h"
#include "limber/skeleton/skeleton.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// The volume that each joint moves, everywhere as dense, and its middle: each triangle, shared among joints by its
// corners' weights, makes a tetrahedron with the middle of its joint's own surface. In the units of metres cubed;
// joints that move no volume are left out; none where the surface has no weights.
//
// skeleton  in bind pose, as the positions are; a joint whose bind matrix has no inverse is left out
std::vector<PointMass> bodyMasses(const Geometry& geometry, const SkinWeights& weights, const Skeleton& skeleton);

}  // namespace limber
