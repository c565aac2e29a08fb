// The triangles at each vertex of a mesh, and the neighbours of a vertex.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "limber/core/grouped.h"

namespace limber {

// By vertex, ascending.
inline Grouped<Index> trianglesAtVertices(std::span<const Triangle> triangles, std::size_t vertexCount) {
  return {vertexCount, [&](const auto& visit) {
            for (Index t = 0; t < triangles.size(); ++t) {
              for (const Index v : triangles[t]) visit(v, t);
            }
          }};
}

// The vertices that have an edge with this one, ascending. `trianglesAt` as trianglesAtVertices gives them.
inline std::vector<Index> neighboursOf(Index vertex, std::span<const Triangle> triangles,
                                       const Grouped<Index>& trianglesAt) {
  std::vector<Index> neighbours;
  for (const Index t : trianglesAt.of(vertex)) {
    for (const Index v : triangles[t]) {
      if (v != vertex) neighbours.push_back(v);
    }
  }
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  return neighbours;
}

}  // namespace limber
