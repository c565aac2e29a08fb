// A sphere mesh without the progress that tests do not watch. Not installed.
#pragma once

#include "limber/core/progress.h"
#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber::testing {

inline SphereMesh sphereMeshOf(const TriMesh& mesh) {
  Progress progress;
  return SphereMesh::build(mesh, progress);
}

}  // namespace limber::testing
