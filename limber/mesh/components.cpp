#include "limber/mesh/components.h"

#include <numeric>
#include <utility>

namespace limber {

namespace {

// The lowest vertex of the set, halving the path on the way.
Index findRoot(std::vector<Index>& parent, Index vertex) {
  while (parent[vertex] != vertex) {
    parent[vertex] = parent[parent[vertex]];
    vertex = parent[vertex];
  }
  return vertex;
}

// The lower root stays, so that every root is the lowest vertex of its piece.
void unite(std::vector<Index>& parent, Index a, Index b) {
  a = findRoot(parent, a);
  b = findRoot(parent, b);
  if (a > b) std::swap(a, b);
  parent[b] = a;
}

}  // namespace

std::vector<Index> vertexComponents(const TriMesh& mesh, Index* count) {
  std::vector<Index> piece(mesh.vertexCount());
  std::iota(piece.begin(), piece.end(), Index{0});
  for (const Triangle& t : mesh.triangles) {
    unite(piece, t[0], t[1]);
    unite(piece, t[0], t[2]);
  }

  // Parents are never above their children, so one pass upwards replaces each parent by its piece's number.
  Index pieces = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) piece[v] = piece[v] == v ? pieces++ : piece[piece[v]];
  if (count) *count = pieces;
  return piece;
}

}  // namespace limber
