// The surface point nearest to a point, among triangles that face about the same direction.
#pragma once

#include <array>
#include <optional>

#include "limber/geometry/mesh/bvh.h"

namespace limber {

// The mesh with its triangles turned to face outwards, as far as that can be told (surfaceEdges).
TriMesh facingOutwards(TriMesh mesh);

// A tree over all triangles and six over those that face along +x, -x, ..., -z. Cost: that of four trees (Bvh).
class FacingSurface {
 public:
  // mesh  facing outwards; one triangle or more
  explicit FacingSurface(const TriMesh& mesh);

  SurfacePoint nearest(const Vec3& point) const { return all_.nearestPoint(point); }

  // Among the triangles within about 70 degrees of the axis that `normal` is nearest to: none of them is turned away
  // from it. Nothing where there is no such triangle, or the normal is zero.
  std::optional<SurfacePoint> nearestFacing(const Vec3& point, const Vec3& normal) const;

 private:
  Bvh all_;
  std::array<std::optional<Bvh>, 6> facing_;
};

}  // namespace limber
