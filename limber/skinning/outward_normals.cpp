#include "limber/skinning/outward_normals.h"

#include <cmath>
#include <span>

#include "limber/mesh/edge_groups.h"

namespace limber {

namespace {

// How clearly a patch must be inside out to be turned: 1 for a sphere, near 0 for a sheet.
constexpr double kInsideOut = 0.2;

// By side: the side across its edge, where exactly two lie there; otherwise kNoIndex.
std::vector<Index> findNeighbours(const TriMesh& mesh) {
  std::vector<Index> across(3 * mesh.triangles.size(), kNoIndex);
  EdgeGroups(mesh.triangles, mesh.vertexCount()).forEachEdge([&](std::span<const Index> sides) {
    if (sides.size() != 2) return;
    across[sides[0]] = sides[1];
    across[sides[1]] = sides[0];
  });
  return across;
}

// Whether two triangles run opposite ways along their common edge, as neighbours should.
bool agree(const TriMesh& mesh, Index side, Index other) {
  return mesh.triangles[side / 3][side % 3] != mesh.triangles[other / 3][other % 3];
}

// Twice the area, along the normal.
Vec3 areaNormal(const TriMesh& mesh, Index t) {
  const Triangle& triangle = mesh.triangles[t];
  const Vec3 a = mesh.position(triangle[0]);
  return (mesh.position(triangle[1]) - a).cross(mesh.position(triangle[2]) - a);
}

Vec3 centroid(const TriMesh& mesh, Index t) {
  const Triangle& triangle = mesh.triangles[t];
  return (mesh.position(triangle[0]) + mesh.position(triangle[1]) + mesh.position(triangle[2])) / 3;
}

// Whether a patch, its triangles taken with the signs given, is to be turned round.
bool facesInward(const TriMesh& mesh, const std::vector<Index>& patch, const std::vector<int>& sign) {
  double stored = 0, area = 0;
  Vec3 middle = Vec3::Zero();
  for (const Index t : patch) {
    const double twice = areaNormal(mesh, t).norm();
    stored += sign[t] * twice;
    area += twice;
    middle += twice * centroid(mesh, t);
  }
  if (!(area > 0)) return false;
  middle /= area;
  const double side = stored < 0 ? -1 : 1;
  double outward = 0, all = 0;
  for (const Index t : patch) {
    const Vec3 normal = areaNormal(mesh, t), arm = centroid(mesh, t) - middle;
    outward += side * sign[t] * normal.dot(arm);
    all += normal.norm() * arm.norm();
  }
  return (outward < -kInsideOut * all) != (side < 0);
}

// +1 for a triangle that stays as it is, -1 for one to turn.
std::vector<int> orientations(const TriMesh& mesh) {
  const std::vector<Index> across = findNeighbours(mesh);
  std::vector<int> sign(mesh.triangles.size(), 0);
  std::vector<Index> patch;
  for (Index seed = 0; seed < mesh.triangleCount(); ++seed) {
    if (sign[seed] != 0) continue;
    patch.assign(1, seed);
    sign[seed] = 1;
    for (std::size_t next = 0; next < patch.size(); ++next) {
      const Index t = patch[next];
      for (Index side = 3 * t; side < 3 * t + 3; ++side) {
        if (across[side] == kNoIndex || sign[across[side] / 3] != 0) continue;
        sign[across[side] / 3] = agree(mesh, side, across[side]) ? sign[t] : -sign[t];
        patch.push_back(across[side] / 3);
      }
    }
    if (!facesInward(mesh, patch, sign)) continue;
    for (const Index t : patch) sign[t] = -sign[t];
  }
  return sign;
}

}  // namespace

std::vector<Vec3> outwardNormals(const TriMesh& mesh) {
  const std::vector<int> sign = orientations(mesh);
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vec3 normal = areaNormal(mesh, t);
    const double twice = normal.norm();
    if (!(twice > 0)) continue;
    const Triangle& triangle = mesh.triangles[t];
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 at = mesh.position(triangle[corner]);
      const Vec3 u = mesh.position(triangle[(corner + 1) % 3]) - at, v = mesh.position(triangle[(corner + 2) % 3]) - at;
      normals[triangle[corner]] += (sign[t] * std::atan2(twice, u.dot(v)) / twice) * normal;
    }
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    normal = length > 1e-9 ? Vec3(normal / length) : Vec3(Vec3::Zero());
  }
  return normals;
}

}  // namespace limber
