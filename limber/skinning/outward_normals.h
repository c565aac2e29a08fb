// Which way is out, on meshes whose faces do not agree about it.
#pragma once

#include <vector>

#include "limber/mesh/tri_mesh.h"

namespace limber {

// #V unit normals, the mean of the adjoining triangles' normals by the angle that each spans there; zero where there
// is no triangle or they cancel out.
//
// Triangles are turned to agree with their neighbours across every edge of two. A patch of such triangles faces the way
// that the greater part of its area was stored, unless it then clearly encloses its own middle from the wrong side: so
// neither single flipped faces, as scans have them, nor a model stored inside out matters.
// Cost: O(#F).
std::vector<Vec3> outwardNormals(const TriMesh& mesh);

}  // namespace limber
