#include "limber/evaluate/pairing.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "limber/geometry/mesh/normals.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/skeleton/skeleton.h"

namespace limber {

namespace {

constexpr double kPairTolerance = 1e-4;  // of the diagonal
constexpr double kEqualDistance = 1e-6;  // of the diagonal: vertices so much farther than the nearest are as near

Box boundsOf(const TriMesh& mesh) {
  Box box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
  return box;
}

bool sameOrder(const TriMesh& from, const TriMesh& to, double tolerance) {
  if (from.vertexCount() != to.vertexCount()) return false;
  for (Index v = 0; v < from.vertexCount(); ++v) {
    if (!((from.position(v) - to.position(v)).norm() <= tolerance)) return false;
  }
  return true;
}

std::vector<Vec3> vertexNormals(const TriMesh& mesh) {
  std::vector<Vec3> normals = areaNormals<Vec3f>(mesh.positions, mesh.triangles);
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

// Points in cubes of twice the search distance, so that a search looks at eight of them.
class PointGrid {
 public:
  PointGrid(const TriMesh& mesh, double reach) : mesh_(mesh), reach_(reach), cell_(std::max(2 * reach, 1e-30)) {
    for (Index v = 0; v < mesh.vertexCount(); ++v) cells_[keyOf(mesh.position(v) / cell_)].push_back(v);
  }

  // Calls visit(vertex, distance) for the points within reach.
  template <typename Visit>
  void near(const Vec3& point, Visit visit) const {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 half(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      const auto cell = cells_.find(keyOf(point / cell_ + half));
      if (cell == cells_.end()) continue;
      for (const Index v : cell->second) {
        const double distance = (mesh_.position(v) - point).norm();
        if (distance <= reach_) visit(v, distance);
      }
    }
  }

 private:
  static std::uint64_t keyOf(const Vec3& scaled) {
    std::uint64_t key = 0;
    for (int i = 0; i < 3; ++i) {
      const auto cell = static_cast<std::int64_t>(std::floor(std::clamp(scaled[i], -1e15, 1e15)));
      key = (key ^ static_cast<std::uint64_t>(cell)) * 0x9E3779B97F4A7C15u;
      key ^= key >> 29;
    }
    return key;  // cells of one key merely have one list: distances are checked
  }

  const TriMesh& mesh_;
  double reach_, cell_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

}  // namespace

VertexPairs pairVertices(const TriMesh& from, const TriMesh& to) {
  VertexPairs result;
  result.partner.resize(from.vertexCount(), kNoIndex);
  const double diagonal = boundsOf(to).size().norm();
  if (sameOrder(from, to, kPairTolerance * diagonal)) {
    result.orderKept = true;
    for (Index v = 0; v < from.vertexCount(); ++v) result.partner[v] = v;
    return result;
  }
  const std::vector<Vec3> fromNormals = vertexNormals(from), toNormals = vertexNormals(to);
  const PointGrid grid(to, kPairTolerance * diagonal);
  for (Index v = 0; v < from.vertexCount(); ++v) {
    const Vec3 point = from.position(v);
    double nearest = std::numeric_limits<double>::infinity();
    grid.near(point, [&](Index, double distance) { nearest = std::min(nearest, distance); });
    double alike = -std::numeric_limits<double>::infinity();
    grid.near(point, [&](Index candidate, double distance) {
      if (distance > nearest + kEqualDistance * diagonal) return;
      const double cosine = fromNormals[v].dot(toNormals[candidate]);
      if (cosine > alike || (cosine == alike && candidate < result.partner[v])) {
        alike = cosine;
        result.partner[v] = candidate;
      }
    });
  }
  return result;
}

std::vector<Index> pairJoints(const Skeleton& from, const Skeleton& to) {
  std::unordered_map<std::string_view, Index> jointOfName;
  for (Index j = 0; j < to.jointCount(); ++j) jointOfName.emplace(to.joints[j].name, j);
  std::vector<Index> partner(from.jointCount(), kNoIndex);
  bool shared = false;
  for (Index j = 0; j < from.jointCount(); ++j) {
    const auto found = jointOfName.find(from.joints[j].name);
    if (found == jointOfName.end()) continue;
    partner[j] = found->second;
    shared = true;
  }
  if (!shared && from.jointCount() == to.jointCount()) {
    for (Index j = 0; j < from.jointCount(); ++j) partner[j] = j;
  }
  return partner;
}

}  // namespace limber
