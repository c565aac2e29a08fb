// The outward direction, on meshes whose faces do not agree about it.
#pragma once

#include <vector>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {

// #V unit normals, the mean of the adjoining triangles' normals by the angle that each spans there; zero where there
// is no triangle or they cancel out.
//
// Triangles count as reversedFaces has them, so that neither single reversed faces, as scans have them, nor a model
// stored inside out matters. Cost: that of reversedFaces.
std::vector<Vec3> outwardNormals(const TriMesh& mesh);

}  // namespace limber
