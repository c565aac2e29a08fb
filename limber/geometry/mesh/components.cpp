#include "limber/geometry/mesh/components.h"

#include "limber/core/disjoint_sets.h"

namespace limber {

std::vector<Index> vertexComponents(const TriMesh& mesh, Index* count) {
  DisjointSets sets(mesh.vertexCount());
  for (const Triangle& t : mesh.triangles) {
    sets.unite(t[0], t[1]);
    sets.unite(t[0], t[2]);
  }

  // A piece's lowest vertex names it, and so has its number before the others ask for it.
  std::vector<Index> piece(mesh.vertexCount());
  Index pieces = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Index first = sets.find(v);
    piece[v] = first == v ? pieces++ : piece[first];
  }
  if (count) *count = pieces;
  return piece;
}

}  // namespace limber
