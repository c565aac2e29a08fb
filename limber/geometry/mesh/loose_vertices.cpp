#include "limber/geometry/mesh/loose_vertices.h"

#include <algorithm>

namespace limber {

std::optional<BareSurface> withoutLooseVertices(const TriMesh& mesh) {
  std::vector<Index> kept(mesh.vertexCount(), kNoIndex);
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) kept[v] = 0;
  }
  if (mesh.triangles.empty() || std::find(kept.begin(), kept.end(), kNoIndex) == kept.end()) return std::nullopt;
  BareSurface result;
  for (Index v = 0; v < kept.size(); ++v) {
    if (kept[v] == kNoIndex) continue;
    kept[v] = result.mesh.vertexCount();
    result.mesh.positions.push_back(mesh.positions[v]);
    result.source.push_back(v);
  }
  result.mesh.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) result.mesh.triangles.push_back({kept[t[0]], kept[t[1]], kept[t[2]]});
  return result;
}

}  // namespace limber
