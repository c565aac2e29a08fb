// A capsule, of which tests put bodies together. Not installed.
#pragma once

#include <cmath>

#include "limber/geometry/mesh/tri_mesh.h"

namespace limber::testing {

// A closed capsule round the segment a-b.
inline void addCapsule(TriMesh& mesh, const Vec3& a, const Vec3& b, double radius) {
  constexpr int kAround = 16, kRings = 6;  // rings of each half ball
  const Vec3 axis = (b - a).normalized();
  const Vec3 side = axis.unitOrthogonal(), other = axis.cross(side);
  const Index first = mesh.vertexCount();
  const auto add = [&](const Vec3& p) { mesh.positions.push_back(p.cast<float>()); };
  add(a - radius * axis);
  for (int ring = 1; ring <= 2 * kRings; ++ring) {
    const bool lower = ring <= kRings;
    const double slope = M_PI / 2 * (lower ? ring - kRings : ring - kRings - 1) / kRings;
    const Vec3 center = (lower ? a : b) + radius * std::sin(slope) * axis;
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * M_PI * i / kAround;
      add(center + radius * std::cos(slope) * (std::cos(angle) * side + std::sin(angle) * other));
    }
  }
  add(b + radius * axis);
  const Index last = mesh.vertexCount() - 1;
  const auto at = [&](int ring, int i) { return first + 1 + static_cast<Index>(ring * kAround + i % kAround); };
  for (int i = 0; i < kAround; ++i) {
    mesh.triangles.push_back({first, at(0, i + 1), at(0, i)});
    for (int ring = 0; ring + 1 < 2 * kRings; ++ring) {
      mesh.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i)});
      mesh.triangles.push_back({at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
    }
    mesh.triangles.push_back({last, at(2 * kRings - 1, i), at(2 * kRings - 1, i + 1)});
  }
}

}  // namespace limber::testing
