// Normals for shading: smooth over curved parts, sharp at creases.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// #F * 3 unit normals, one for each corner: the mean, weighted by corner angle, of the faces round that position whose
// normal is within the crease angle of the corner's own face. Vertices at equal positions count as one. The normal of
// a face without area is zero.
//
// cosCrease  cosine of the crease angle
// Cost: O(#F) at bounded vertex degree; above 64 faces round a position creases are ignored there.
std::vector<Vec3f> cornerNormals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                 double cosCrease = 0.5);

}  // namespace limber
