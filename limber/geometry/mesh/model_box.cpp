#include "limber/geometry/mesh/model_box.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"

namespace limber {

namespace {

constexpr double kMax = 0.98;  // of the area: what counts for the size wherever it lies

struct SurfacePiece {
  Box box;
  double area = 0;
  Vec3 center = Vec3::Zero();  // of the area; of the box where there is none
};

std::vector<SurfacePiece> surfacePieces(const TriMesh& mesh) {
  Index count = 0;
  const std::vector<Index> pieceOf = vertexComponents(mesh, &count);
  std::vector<SurfacePiece> pieces(count);
  for (const Triangle& t : mesh.triangles) {
    SurfacePiece& piece = pieces[pieceOf[t[0]]];
    const double area = triangleArea(mesh, t);
    piece.area += area;
    for (const Index v : t) {
      piece.box.add(mesh.position(v));
      piece.center += area / 3 * mesh.position(v);
    }
  }
  std::erase_if(pieces, [](const SurfacePiece& piece) { return piece.box.empty(); });
  for (SurfacePiece& piece : pieces) {
    piece.center = piece.area > 0 ? Vec3(piece.center / piece.area) : piece.box.center();
  }
  return pieces;
}

// Along each axis half of the area lies on either side.
Vec3 medianCenter(const std::vector<SurfacePiece>& pieces, double area) {
  std::vector<Index> order(pieces.size());
  std::iota(order.begin(), order.end(), Index{0});
  Vec3 median;
  for (int axis = 0; axis < 3; ++axis) {
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return pieces[a].center[axis] < pieces[b].center[axis]; });
    double below = 0;
    for (const Index piece : order) {
      median[axis] = pieces[piece].center[axis];
      below += pieces[piece].area;
      if (below >= 0.5 * area) break;
    }
  }
  return median;
}

void addBox(Box& box, const Box& other) {
  box.add(other.min);
  box.add(other.max);
}

}  // namespace

Box surfaceBox(const TriMesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) box.add(mesh.position(v));
  }
  return box;
}

Box modelBox(const TriMesh& mesh) {
  Box all;
  if (mesh.triangles.empty()) {
    for (Index v = 0; v < mesh.vertexCount(); ++v) all.add(mesh.position(v));
    return all;
  }
  std::vector<SurfacePiece> pieces = surfacePieces(mesh);
  double area = 0;
  for (const SurfacePiece& piece : pieces) {
    addBox(all, piece.box);
    area += piece.area;
  }
  if (pieces.size() < 2 || !(area > 0)) return all;

  const Vec3 middle = medianCenter(pieces, area);
  std::stable_sort(pieces.begin(), pieces.end(), [&](const SurfacePiece& a, const SurfacePiece& b) {
    return (a.center - middle).squaredNorm() < (b.center - middle).squaredNorm();
  });
  Box most;
  double maxArea = 0;
  for (const SurfacePiece& piece : pieces) {
    addBox(most, piece.box);
    maxArea += piece.area;
    if (maxArea >= kMax * area) break;
  }
  const Vec3 reach = Vec3::Constant(kFarAway * most.longestSide());
  const Vec3 low = most.min - reach, high = most.max + reach;
  Box model = most;
  for (const SurfacePiece& piece : pieces) {
    const bool isFar = (piece.box.min.array() > high.array()).any() || (piece.box.max.array() < low.array()).any();
    if (!isFar) addBox(model, piece.box);
  }
  return model;
}

}  // namespace limber
