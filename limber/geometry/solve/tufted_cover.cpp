// Builds the tufted cover of Sharp, Crane: A Laplacian for Nonmanifold Triangle Meshes, 2020.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/edge_groups.h"
#include "limber/geometry/solve/intrinsic_triangulation.h"

namespace limber {

namespace {

std::vector<Triangle> properTriangles(const TriMesh& mesh) {
  std::vector<Triangle> result = mesh.triangles;
  const auto degenerate = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  result.erase(std::remove_if(result.begin(), result.end(), degenerate), result.end());
  return result;
}

// Which vertices lie in a piece that needs both sides.
std::vector<char> findTwoSided(const EdgeGroups& edges, const std::vector<Index>& piece) {
  std::vector<char> open(piece.size(), 0);  // by piece; there are no more of them than vertices
  edges.forEachEdge([&](std::span<const Index> sides) {
    const bool closed = sides.size() == 2 && edges.ascends(sides[0]) != edges.ascends(sides[1]);
    if (!closed) open[piece[edges.low(sides[0])]] = 1;
  });
  std::vector<char> result(piece.size());
  for (std::size_t v = 0; v < piece.size(); ++v) result[v] = open[piece[v]];
  return result;
}

// Orders the sides of an edge by the angle at which their triangles stand around it, right-handed about the direction
// from its lower to its higher vertex.
void sortAroundEdge(std::vector<Index>& sides, const EdgeGroups& edges, const TriMesh& mesh) {
  const Vec3 start = mesh.position(edges.low(sides[0]));
  const Vec3 axis = mesh.position(edges.high(sides[0])) - start;
  const auto apex = [&](Index side) {
    const Vec3 arm = mesh.position(edges.corner(nextSide(nextSide(side)))) - start;
    return Vec3(arm * axis.squaredNorm() - arm.dot(axis) * axis);
  };
  const Vec3 reference = apex(sides[0]);
  const Vec3 across = axis.normalized().cross(reference);
  std::vector<std::pair<double, Index>> byAngle;
  for (const Index side : sides) {
    const Vec3 arm = apex(side);
    double angle = std::atan2(arm.dot(across), arm.dot(reference));
    if (angle < 0) angle += 2 * kPi;
    byAngle.emplace_back(angle, side);
  }
  std::sort(byAngle.begin(), byAngle.end());
  for (std::size_t i = 0; i < sides.size(); ++i) sides[i] = byAngle[i].second;
}

class CoverBuilder {
 public:
  CoverBuilder(const TriMesh& mesh, const std::vector<Index>& piece)
      : mesh_(mesh), triangles_(properTriangles(mesh)), edges_(triangles_, mesh.vertexCount()) {
    cover_.twoSided = findTwoSided(edges_, piece);
  }

  IntrinsicTriangulation build() {
    makeFaces();
    edges_.forEachEdge([&](std::span<const Index> sides) { glueEdge(sides); });
    mollify();
    return std::move(cover_);
  }

 private:
  // Front faces first, in the mesh's order; then the back faces, with their corners in reverse order.
  void makeFaces() {
    const Index faceCount = static_cast<Index>(triangles_.size());
    back_.resize(faceCount, kNoIndex);
    Index next = faceCount;
    for (Index f = 0; f < faceCount; ++f) {
      if (cover_.twoSided[triangles_[f][0]]) back_[f] = next++;
    }
    const std::size_t sideCount = 3 * std::size_t{next};
    cover_.from.resize(sideCount);
    cover_.twin.resize(sideCount);
    cover_.length.resize(sideCount);
    for (Index f = 0; f < faceCount; ++f) {
      const Triangle& t = triangles_[f];
      std::copy(t.begin(), t.end(), cover_.from.begin() + 3 * std::size_t{f});
      if (back_[f] == kNoIndex) continue;
      const Triangle reversed = {t[0], t[2], t[1]};
      std::copy(reversed.begin(), reversed.end(), cover_.from.begin() + 3 * std::size_t{back_[f]});
    }
  }

  Index backSide(Index side) const { return 3 * back_[side / 3] + 2 - side % 3; }

  // Going round the edge, each triangle is seen from one of its sides and shows the next triangle the other.
  Index sideFacingOn(Index side) const { return edges_.ascends(side) ? side : backSide(side); }
  Index sideFacingBack(Index side) const { return edges_.ascends(side) ? backSide(side) : side; }

  void glueEdge(std::span<const Index> sides) {
    const double length = (mesh_.position(edges_.low(sides[0])) - mesh_.position(edges_.high(sides[0]))).norm();
    if (back_[sides[0] / 3] == kNoIndex) {
      glue(sides[0], sides[1], length);
      return;
    }
    around_.assign(sides.begin(), sides.end());
    if (sides.size() > 2) sortAroundEdge(around_, edges_, mesh_);
    for (std::size_t i = 0; i < around_.size(); ++i) {
      glue(sideFacingOn(around_[i]), sideFacingBack(around_[(i + 1) % around_.size()]), length);
    }
  }

  void glue(Index a, Index b, double length) {
    cover_.twin[a] = b;
    cover_.twin[b] = a;
    cover_.length[a] = cover_.length[b] = length;
  }

  void mollify() {
    constexpr double kEdgeMargin = 1e-5;  // of the mean edge length, as in the paper
    std::vector<double>& length = cover_.length;
    if (length.empty()) return;
    const double mean = std::accumulate(length.begin(), length.end(), 0.0) / static_cast<double>(length.size());
    const double margin = mean > 0 ? kEdgeMargin * mean : 1;  // all corners at one position: any triangles will do
    double missing = 0;
    for (std::size_t h = 0; h < length.size(); h += 3) {
      const double a = length[h], b = length[h + 1], c = length[h + 2];
      missing = std::max({missing, margin - (a + b - c), margin - (b + c - a), margin - (c + a - b)});
    }
    if (missing <= 0) return;
    for (double& l : length) l += missing;
  }

  const TriMesh& mesh_;
  std::vector<Triangle> triangles_;
  EdgeGroups edges_;
  std::vector<Index> back_;    // #F: the face that covers the back, where there is one
  std::vector<Index> around_;  // scratch of glueEdge
  IntrinsicTriangulation cover_;
};

}  // namespace

IntrinsicTriangulation tuftedCover(const TriMesh& mesh, const std::vector<Index>& piece) {
  return CoverBuilder(mesh, piece).build();
}

}  // namespace limber
