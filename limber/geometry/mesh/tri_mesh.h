// Triangles over shared vertices: what the engine computes on.
#pragma once

#include <vector>

#include "limber/core/types.h"

namespace limber {

// positions  #V points; after prepareMesh centred, longest side of modelBox 1
// triangles  #F vertex triples, counter-clockwise seen from outside (not to be relied on: scans flip faces)
// A vertex may belong to no triangle. Edges may have any number of triangles; nothing about a TriMesh is manifold.
struct TriMesh {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  Index vertexCount() const { return static_cast<Index>(positions.size()); }
  Index triangleCount() const { return static_cast<Index>(triangles.size()); }
  Vec3 position(Index vertex) const { return positions[vertex].cast<double>(); }
};

}  // namespace limber
