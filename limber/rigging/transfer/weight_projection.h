// What a surface carries, brought over to the vertices of another one that it lies on.
#pragma once

#include <span>
#include <vector>

#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/transfer/facing_surface.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Points of `source` that points of another surface take after: the nearest one that faces about its own direction,
// unless that is far and one that does not is much nearer.
class SurfaceProjector {
 public:
  // source  facing outwards, with triangles
  explicit SurfaceProjector(const TriMesh& source);

  SurfacePoint at(const Vec3& position, const Vec3& normal) const;

 private:
  FacingSurface surface_;
  double near_ = 0;
};

// The same for each vertex of `target`. Both facing outwards, with triangles. Cost: O(#V log #F).
std::vector<SurfacePoint> takenAfter(const TriMesh& source, const TriMesh& target);

// Weights of #points target vertices: those of the source at the three corners, mixed by the point's barycentric
// weights, the `slots` strongest to a sum of 1. Where the corners have none at all, those of the nearest source vertex
// that has some.
// Throws Error kBadArgument where no source vertex has any.
SkinWeights projectWeights(const TriMesh& source, const SkinWeights& weights, std::span<const SurfacePoint> points,
                           Index slots);

}  // namespace limber
