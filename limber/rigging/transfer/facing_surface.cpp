#include "limber/rigging/transfer/facing_surface.h"

#include <utility>
#include <vector>

#include "limber/core/parallel.h"
#include "limber/geometry/surface/surface_edges.h"

namespace limber {

namespace {

// Cosine of the widest angle between a triangle's normal and the axis of its tree. Every normal is within 55 degrees of
// an axis; 70 leaves 15 for surfaces that do not quite agree.
constexpr double kFacesAxis = 0.34;

std::vector<Index> trianglesFacing(const TriMesh& mesh, int side) {
  const Vec3 axis = (side % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(side / 2);
  std::vector<Index> triangles;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 normal = (mesh.position(b) - mesh.position(a)).cross(mesh.position(c) - mesh.position(a));
    const double length = normal.norm();
    if (length > 0 && normal.dot(axis) >= kFacesAxis * length) triangles.push_back(t);
  }
  return triangles;
}

}  // namespace

TriMesh facingOutwards(TriMesh mesh) {
  const SurfaceEdges edges = surfaceEdges(mesh);
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    if (edges.facing[t] < 0) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return mesh;
}

FacingSurface::FacingSurface(const TriMesh& mesh) : all_(mesh) {
  parallelFor(6, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t side = begin; side < end; ++side) {
      const std::vector<Index> triangles = trianglesFacing(mesh, static_cast<int>(side));
      if (!triangles.empty()) facing_[side].emplace(mesh, triangles);
    }
  });
}

std::optional<SurfacePoint> FacingSurface::nearestFacing(const Vec3& point, const Vec3& normal) const {
  int axis = 0;
  if (!(normal.cwiseAbs().maxCoeff(&axis) > 0)) return std::nullopt;
  const std::optional<Bvh>& tree = facing_[static_cast<std::size_t>(2 * axis + (normal[axis] < 0 ? 1 : 0))];
  if (!tree) return std::nullopt;
  return tree->nearestPoint(point);
}

}  // namespace limber
