#include "limber/rigging/weights/outward_normals.h"

#include <cmath>

#include "limber/geometry/mesh/face_orientation.h"

namespace limber {

std::vector<Vec3> outwardNormals(const TriMesh& mesh) {
  const std::vector<bool> reversed = reversedFaces(mesh);
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const Vec3 a = mesh.position(triangle[0]);
    const Vec3 normal = (mesh.position(triangle[1]) - a).cross(mesh.position(triangle[2]) - a);
    const double twice = normal.norm();
    if (!(twice > 0)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3 at = mesh.position(triangle[corner]);
      const Vec3 u = mesh.position(triangle[(corner + 1) % 3]) - at, v = mesh.position(triangle[(corner + 2) % 3]) - at;
      normals[triangle[corner]] += ((reversed[t] ? -1 : 1) * std::atan2(twice, u.dot(v)) / twice) * normal;
    }
  }
  for (Vec3& normal : normals) {
    const double length = normal.norm();
    normal = length > 1e-9 ? Vec3(normal / length) : Vec3(Vec3::Zero());
  }
  return normals;
}

}  // namespace limber
