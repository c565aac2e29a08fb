#include "limber/geometry/mesh/prepare.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/geometry/mesh/model_box.h"

namespace limber {

namespace {

void checkInput(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
  for (std::size_t v = 0; v < positions.size(); ++v) {
    if (!positions[v].allFinite()) {
      throw Error(ErrorCode::kBadData, "has a position that is not a finite number", fmt::format("vertex {}", v));
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Index v : triangles[t]) {
      if (v < positions.size()) continue;
      throw Error(ErrorCode::kBadArgument, fmt::format("names vertex {} of {}", v, positions.size()),
                  fmt::format("triangle {}", t));
    }
  }
}

WorkingFrame frameOf(const Box& box) {
  WorkingFrame frame;
  frame.offset = box.center();
  if (box.longestSide() > 0) frame.scale = box.longestSide();
  return frame;
}

// Vertices that do not count for the model's size, though they have triangles or are far away from it.
void warnOfFarVertices(const TriMesh& mesh, const Box& box, Warnings& warnings) {
  std::vector<bool> isOfSurface(mesh.vertexCount(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const Index v : t) isOfSurface[v] = true;
  }
  const double farAway = kFarAway * box.longestSide();
  std::size_t count = 0;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    const Vec3 p = mesh.position(v);
    const double outside = (box.min - p).cwiseMax(p - box.max).maxCoeff();
    if (outside > (isOfSurface[v] ? 0 : farAway)) ++count;
  }
  warnings.add("far-vertices", "vertices far away from the rest of the model do not count for its size", {}, count);
}

// Far vertices must fit into single precision.
void moveToFrame(const WorkingFrame& frame, std::vector<Vec3f>& positions) {
  constexpr double kFarthest = 1e4;  // longest sides from the centre; what counts for the size lies within 0.5
  for (Vec3f& p : positions) {
    p = frame.toWorking(p.cast<double>()).cwiseMax(-kFarthest).cwiseMin(kFarthest).cast<float>();
  }
}

}  // namespace

PreparedMesh prepareMesh(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                         std::span<const StoredVertices> stored) {
  checkInput(positions, triangles);
  PreparedMesh result;
  TriMesh& mesh = result.mesh;

  const std::vector<Index> same = samePoints(positions, triangles, stored);
  result.weldedVertex.reserve(positions.size());
  mesh.positions.reserve(positions.size());
  for (Index v = 0; v < positions.size(); ++v) {
    result.weldedVertex.push_back(same[v] == v ? mesh.vertexCount() : result.weldedVertex[same[v]]);
    if (same[v] == v) mesh.positions.push_back(positions[v]);
  }

  mesh.triangles.reserve(triangles.size());
  for (const Triangle& source : triangles) {
    const Triangle t = {result.weldedVertex[source[0]], result.weldedVertex[source[1]], result.weldedVertex[source[2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  result.warnings.add("degenerate-triangles", "triangles with two corners at one place are left out of the computation",
                      {}, triangles.size() - mesh.triangles.size());
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::kBadData, "has no triangle", {}, "limber needs a surface, not points or lines");
  }

  const Box box = modelBox(mesh);
  warnOfFarVertices(mesh, box, result.warnings);
  result.frame = frameOf(box);
  moveToFrame(result.frame, mesh.positions);
  return result;
}

}  // namespace limber
