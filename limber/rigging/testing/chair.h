// A thing that a person fits into, for tests of what tells bodies from things. Not installed.
#pragma once

#include "limber/geometry/mesh/testing/box.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// A kitchen chair of boards, 0.97 high, its back at -Z.
inline TriMesh chair() {
  TriMesh mesh;
  addBox(mesh, {-0.24f, 0.43f, -0.22f}, {0.24f, 0.47f, 0.22f});
  for (const float x : {-0.22f, 0.22f}) {
    addBox(mesh, {x - 0.02f, 0, 0.18f}, {x + 0.02f, 0.43f, 0.22f});
    addBox(mesh, {x - 0.02f, 0, -0.22f}, {x + 0.02f, 0.97f, -0.18f});
  }
  for (const float y : {0.6f, 0.87f}) addBox(mesh, {-0.2f, y, -0.21f}, {0.2f, y + 0.08f, -0.19f});
  return mesh;
}

}  // namespace limber::testing
