// A model's surface with points spread evenly over it, whatever its own vertices are like.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/sphere_mesh/sphere_mesh_builder.h"

namespace limber {

// A 2-complex: edges may have no triangle, or any number of them. Of a model that is its own mirror image it is the
// half with x >= 0 alone, so that whatever is made of it can be mirrored exactly.
//
// points     #P, in the collapse's space (CollapseFrame): longest side 1, mirror plane x = 0
// areas      #P, of the surface that each point represents, closed holes included
// onPlane    #P, 1 for points on the mirror plane (x is 0); all 0 without one
// triangles  three different points each, none twice
// edges      of the triangles, and others; ordered, none twice
struct EvenSurface {
  bool isHalf = false;
  std::vector<Vec3> points;
  std::vector<double> areas;
  std::vector<char> onPlane;
  std::vector<Triangle> triangles;
  std::vector<VertexPair> edges;
};

inline constexpr Index kMaxEvenPoints = 3000;  // of the whole model

// Closes holes by fans, splits edges that are longer than points of an even sampling are apart, then gathers points
// that the surface joins within one cell of a grid, until there are at most `maxPoints` (of the whole model). What
// hangs together still does; what merely lies close stays apart. Of a model with `mirror` the side x < 0 is left out.
//
// Points without a triangle are left out. Empty where there is no triangle. Cost: O(#V + #F) and some 100 bytes a
// vertex.
EvenSurface evenSurface(const TriMesh& mesh, const CollapseFrame& frame, bool isMirrored,
                        Index maxPoints = kMaxEvenPoints);

// The whole model: the half and its mirror image, joined on the plane.
struct UnfoldedSurface {
  TriMesh mesh;
  std::vector<Index> image;  // #P: the vertex of a point's mirror image, the point itself on the plane; a point is the
                             // vertex of its own number. Empty where the surface is no half
};
UnfoldedSurface unfolded(const EvenSurface& surface);

}  // namespace limber
