#include "limber/geometry/mesh/turned_pieces.h"

#include <array>

#include "limber/geometry/mesh/components.h"

namespace limber {

std::vector<bool> turnedPieces(const TriMesh& mesh) {
  Index count = 0;
  const std::vector<Index> pieceOf = vertexComponents(mesh, &count);
  std::vector<Vec3> middle(count, Vec3::Zero());
  std::vector<double> area(count, 0.0), volume(count, 0.0);
  const auto corners = [&](const Triangle& t) {
    return std::array<Vec3, 3>{mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
  };
  for (const Triangle& t : mesh.triangles) {
    const auto [a, b, c] = corners(t);
    const double part = (b - a).cross(c - a).norm();
    middle[pieceOf[t[0]]] += part * (a + b + c) / 3;
    area[pieceOf[t[0]]] += part;
  }
  for (const Triangle& t : mesh.triangles) {
    const Index piece = pieceOf[t[0]];
    if (!(area[piece] > 0)) continue;
    const auto [a, b, c] = corners(t);
    const Vec3 m = middle[piece] / area[piece];
    volume[piece] += (a - m).dot((b - m).cross(c - m));
  }
  std::vector<bool> turned(mesh.triangles.size());
  for (std::size_t t = 0; t < turned.size(); ++t) turned[t] = volume[pieceOf[mesh.triangles[t][0]]] < 0;
  return turned;
}

}  // namespace limber
