// Animals made of capsules and cones, for tests of what reads bodies. Not installed.
#pragma once

#include <vector>

#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// A chain of capsules through positions, from one radius to the other; on both sides where it is off the middle.
inline void addChain(TriMesh& mesh, const std::vector<Vec3>& positions, double first, double last) {
  constexpr int kSteps = 6;  // between two positions
  const double count = static_cast<double>(kSteps * (positions.size() - 1));
  for (const double side : {1.0, -1.0}) {
    double done = 0;
    bool isPaired = false;
    for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
      isPaired = isPaired || positions[i + 1].x() != 0;
      if (side < 0 && !isPaired) continue;
      for (int s = 0; s < kSteps; ++s, done += 1) {
        const auto at = [&](int step) {
          return Vec3((positions[i] + static_cast<double>(step) / kSteps * (positions[i + 1] - positions[i]))
                          .cwiseProduct(Vec3(side, 1, 1)));
        };
        addCapsule(mesh, at(s), at(s + 1), first + (last - first) * done / count);
      }
    }
  }
}

// All about one metre long, their heads at +Z, feet on y = 0.
inline TriMesh capsuleHound() {
  TriMesh mesh;
  addChain(mesh, {{0, 0.42, -0.25}, {0, 0.42, 0.2}}, 0.09, 0.1);
  addChain(mesh, {{0, 0.44, 0.22}, {0, 0.6, 0.36}, {0, 0.58, 0.5}}, 0.07, 0.03);
  addChain(mesh, {{0, 0.44, -0.3}, {0, 0.36, -0.5}}, 0.03, 0.012);
  addChain(mesh, {{0.05, 0.38, 0.18}, {0.08, 0.2, 0.15}, {0.08, 0.02, 0.17}}, 0.05, 0.025);
  addChain(mesh, {{0.05, 0.38, -0.24}, {0.08, 0.2, -0.2}, {0.08, 0.02, -0.24}}, 0.05, 0.025);
  return mesh;
}

inline TriMesh capsuleTheropod() {
  TriMesh mesh;
  addChain(mesh, {{0, 0.4, -0.02}, {0, 0.45, 0.25}, {0, 0.52, 0.42}, {0, 0.5, 0.52}}, 0.09, 0.04);
  addChain(mesh, {{0, 0.4, -0.02}, {0, 0.37, -0.3}, {0, 0.33, -0.6}}, 0.08, 0.008);
  addChain(mesh, {{0.06, 0.36, 0}, {0.09, 0.2, 0.08}, {0.09, 0.1, -0.04}, {0.09, 0.02, 0.06}}, 0.05, 0.02);
  addChain(mesh, {{0.05, 0.42, 0.24}, {0.1, 0.32, 0.3}, {0.1, 0.26, 0.38}}, 0.02, 0.012);
  return mesh;
}

// `pairs` of legs, the body hung between them.
inline TriMesh capsuleSpider(int pairs) {
  TriMesh mesh;
  addChain(mesh, {{0, 0.16, 0.02}, {0, 0.16, 0.14}}, 0.08, 0.05);
  addChain(mesh, {{0, 0.16, 0}, {0, 0.18, -0.22}}, 0.05, 0.11);
  for (int i = 0; i < pairs; ++i) {
    const double z = 0.12 - 0.16 * i / (pairs - 1), out = 0.3 - 0.6 * i / (pairs - 1);
    addChain(mesh, {{0.03, 0.16, z}, {0.22, 0.3, z + 0.5 * out}, {0.45, 0.02, z + out}}, 0.02, 0.014);
  }
  return mesh;
}

inline TriMesh capsuleSnake() {
  TriMesh mesh;
  addChain(mesh, {{0, 0.03, -0.5}, {0, 0.04, -0.1}}, 0.012, 0.04);
  addChain(mesh, {{0, 0.04, -0.1}, {0, 0.06, 0.2}, {0, 0.3, 0.3}, {0, 0.36, 0.42}}, 0.04, 0.045);
  return mesh;
}

// Tail fin upright, a pair of broad fins at its sides.
inline TriMesh capsuleFish() {
  TriMesh mesh;
  addChain(mesh, {{0, 0.2, 0.38}, {0, 0.2, 0.15}}, 0.07, 0.13);
  addChain(mesh, {{0, 0.2, 0.15}, {0, 0.2, -0.4}}, 0.13, 0.025);
  for (const double up : {-1.0, 1.0}) addChain(mesh, {{0, 0.2, -0.38}, {0, 0.2 + 0.12 * up, -0.5}}, 0.02, 0.012);
  for (const double z : {0.06, 0.09, 0.12, 0.15, 0.18}) {
    addChain(mesh, {{0.09, 0.17, z}, {0.3, 0.12, z - 0.1}}, 0.018, 0.015);
  }
  return mesh;
}

}  // namespace limber::testing
