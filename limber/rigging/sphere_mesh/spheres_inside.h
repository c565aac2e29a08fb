// Spheres of thin and curved parts, whose centres the collapse leaves in the air, brought into what they represent.
#pragma once

#include <optional>
#include <span>

#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/geometry/surface/mirror_map.h"
#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber {

// A sphere whose centre the surface does not wind round becomes the largest ball that touches the surface from within
// where that is nearest to the middle of the sphere's part, found by shrinking one that touches there (Ma, Bae, Choi: 3D
// medial axis point approximation using nearest neighbors and the normal field, 2012). So the half of a rim has its
// sphere in the middle of that half, not in the middle of the ring. A sphere stays where nothing is inside there: sheets,
// and what would have to leave the mirror plane, or come to it. Images stay images.
//
// level     of a sphere mesh of `mesh`
// sphereOf  #V, SphereMesh::vertexHandles() of that level
// mirror    SphereMesh::mirror()
// Cost: O(#spheres #F), and O(#F log #F) where one has to be moved.
void moveSpheresInside(SphereMeshLevel& level, const TriMesh& mesh, std::span<const Index> sphereOf,
                       const std::optional<MirrorPlane>& mirror);

}  // namespace limber
