// A polygon in space as triangles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// Appends triangles of corners 0 to corners.size() - 1, in the polygon's own direction: ears are cut off in the plane
// across the polygon's area normal (Newell's), so that concave polygons come out right. A quadrangle that either
// diagonal could split is cut along the shorter one. Where no ear is left (a polygon that crosses itself or has no
// area) the rest becomes a fan; so does one of more than 1024 corners that is not convex. At least three corners;
// #corners - 2 triangles. Cost: linear for convex polygons, quadratic in the corners otherwise.
void triangulatePolygon(std::span<const Vec3> corners, std::vector<std::array<Index, 3>>& triangles);

}  // namespace limber
