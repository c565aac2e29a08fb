#include "limber/rigging/weights/specks.h"

#include <algorithm>
#include <map>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/rigging/weights/influence_table.h"

namespace limber {

namespace {

constexpr Index kSpeckTriangles = 16;
constexpr double kSpeckSize = 0.05;   // of the model
constexpr double kSpecksOfAll = 0.1;  // of the area

struct PieceSize {
  Index triangles = 0;
  double area = 0;
  Box box;
};

// By piece whether it is a speck; empty where there is none.
std::vector<bool> findSpecks(const TriMesh& mesh, std::span<const Index> pieceOf, Index pieceCount) {
  std::vector<PieceSize> pieces(pieceCount);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    PieceSize& piece = pieces[pieceOf[t[0]]];
    ++piece.triangles;
    piece.area += triangleArea(mesh, t);
    for (const Index v : t) piece.box.add(mesh.position(v));
  }
  const double longest = kSpeckSize * modelBox(mesh).longestSide();
  std::vector<bool> isSpeck(pieceCount, false);
  double ofSpecks = 0;
  for (Index p = 0; p < pieceCount; ++p) {
    const PieceSize& piece = pieces[p];
    area += piece.area;
    isSpeck[p] = piece.triangles > 0 && piece.triangles <= kSpeckTriangles && piece.box.longestSide() <= longest;
    if (isSpeck[p]) ofSpecks += piece.area;
  }
  if (ofSpecks > kSpecksOfAll * area) isSpeck.clear();
  return isSpeck;
}

}  // namespace

void holdSpecks(const TriMesh& mesh, SkinWeights& weights) {
  Index pieceCount = 0;
  const std::vector<Index> pieceOf = vertexComponents(mesh, &pieceCount);
  if (pieceCount < 2) return;
  const std::vector<bool> isSpeck = findSpecks(mesh, pieceOf, pieceCount);
  if (isSpeck.empty()) return;

  std::map<Index, std::vector<Index>> vertices;  // by speck
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (isSpeck[pieceOf[v]]) vertices[pieceOf[v]].push_back(v);
  }
  for (const auto& [piece, own] : vertices) {
    std::map<Index, double> sums;
    for (const Index v : own) {
      for (Index k = 0; k < weights.slots; ++k) sums[weights.jointsOf(v)[k]] += weights.weightsOf(v)[k];
    }
    InfluenceTable strongest(1, weights.slots);
    for (const auto& [joint, sum] : sums) strongest.offer(0, joint, static_cast<float>(sum));
    double total = 0;
    for (const float weight : strongest.weightsOf(0)) total += weight;
    if (!(total > 0)) continue;
    for (const Index v : own) {
      for (Index k = 0; k < weights.slots; ++k) {
        weights.joints[std::size_t{v} * weights.slots + k] = strongest.jointsOf(0)[k];
        weights.weights[std::size_t{v} * weights.slots + k] = static_cast<float>(strongest.weightsOf(0)[k] / total);
      }
    }
  }
}

}  // namespace limber
