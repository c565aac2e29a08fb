// How long the border is that two neighbouring vertices' regions of a surface share.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

// Per edge, in the space of the points. A vertex's region is what the middles of its edges and the barycentres of its
// triangles enclose (the barycentric dual; Meyer, Desbrun, Schroeder, Barr: Discrete Differential-Geometry Operators,
// 2003), so an edge's border runs from its middle to the barycentres of the triangles at it.
//
// edges  of the triangles, as surfaceEdges() orders them
// Cost: O(#F).
std::vector<double> borderLengths(std::span<const Vec3f> points, std::span<const Triangle> triangles,
                                  std::span<const VertexPair> edges);

}  // namespace limber
