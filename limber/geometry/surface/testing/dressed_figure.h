// A figure of open components, and shells within it, for tests.
#pragma once

#include <array>
#include <map>

#include "limber/geometry/mesh/normals.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber::testing {

// blockBiped cut at two heights, with gaps between: its legs, its trunk with the arms, its head; all open.
inline TriMesh openFigure() {
  const TriMesh body = blockBiped(1);
  Box box;
  for (Index v = 0; v < body.vertexCount(); ++v) box.add(body.position(v));
  TriMesh figure;
  for (int band = 0; band < 3; ++band) {
    std::map<Index, Index> vertexOf;
    for (const Triangle& t : body.triangles) {
      const double y = (body.position(t[0]) + body.position(t[1]) + body.position(t[2])).y() / 3 - box.min.y();
      if ((y > 0.35 * box.size().y()) + (y > 0.85 * box.size().y()) != band) continue;
      Triangle corners;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [it, isNew] = vertexOf.try_emplace(t[k], figure.vertexCount());
        if (isNew) figure.positions.push_back(body.positions[t[k]] + Vec3f(0, 0.1f * static_cast<float>(band), 0));
        corners[k] = it->second;
      }
      figure.triangles.push_back(corners);
    }
  }
  return figure;
}

// Every vertex moved against its normal.
inline TriMesh movedInwards(TriMesh mesh, float distance) {
  const std::vector<Vec3> normals = areaNormals<Vec3f>(mesh.positions, mesh.triangles);
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    mesh.positions[v] -= distance * normals[v].normalized().cast<float>();
  }
  return mesh;
}

}  // namespace limber::testing
