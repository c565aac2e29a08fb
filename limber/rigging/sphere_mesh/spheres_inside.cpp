#include "limber/rigging/sphere_mesh/spheres_inside.h"

#include <cmath>
#include <vector>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

constexpr double kTowardsMiddle = 0.1;  // of the way to a triangle's centroid: off its edges, where surfaces meet
constexpr double kTouches = 1e-3;       // of its radius: so little a ball may reach beyond the surface
constexpr int kMaxShrinks = 30;

double heightOver(const MirrorPlane& plane, const Vec3& point) {
  return plane.normal.dot(point) - plane.offset;
}

class SphereMover {
 public:
  SphereMover(const TriMesh& mesh, std::span<const Index> sphereOf) : mesh_(mesh), sphereOf_(sphereOf) {}

  bool isInside(const Vec3& point) const { return areInside(mesh_, std::span(&point, 1))[0]; }

  // The largest ball that touches the surface from within near the middle of the sphere's part; of one that has to stay
  // on the plane only where the surface meets that.
  std::optional<Sphere> inPartOf(Index sphere, const std::optional<MirrorPlane>& plane) {
    std::vector<Index> triangles;
    Box box;
    Vec3 middle = Vec3::Zero();
    double area = 0;
    for (Index t = 0; t < mesh_.triangleCount(); ++t) {
      const double third = triangleArea(mesh_, mesh_.triangles[t]) / 3;
      bool isOfSphere = false;
      for (const Index v : mesh_.triangles[t]) {
        if (sphereOf_[v] != sphere || !(third > 0)) continue;
        isOfSphere = true;
        middle += third * mesh_.position(v);
        area += third;
      }
      if (!isOfSphere) continue;
      for (const Index v : mesh_.triangles[t]) box.add(mesh_.position(v));
      if (!plane || meets(*plane, t)) triangles.push_back(t);
    }
    if (triangles.empty()) return std::nullopt;
    const SurfacePoint nearest = Bvh(mesh_, triangles).nearestPoint(middle / area);
    const Triangle& corners = mesh_.triangles[nearest.triangle];
    const Vec3 a = mesh_.position(corners[0]), b = mesh_.position(corners[1]), c = mesh_.position(corners[2]);
    const Vec3 start = nearest.position + kTowardsMiddle * ((a + b + c) / 3 - nearest.position);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Bvh around = surfaceAround(start, box.diagonal());
    for (const Vec3& inwards : {Vec3(-normal), normal}) {
      const Sphere moved = ballBehind(start, inwards, 0.5 * box.diagonal(), around);
      if (isInside(moved.center)) return moved;
    }
    return std::nullopt;
  }

 private:
  bool meets(const MirrorPlane& plane, Index triangle) const {
    bool isBelow = false, isAbove = false;
    for (const Index v : mesh_.triangles[triangle]) {
      const double height = heightOver(plane, mesh_.position(v));
      isBelow |= height <= 0;
      isAbove |= height >= 0;
    }
    return isBelow && isAbove;
  }

  // What a ball that touches the surface at `center` and is that wide can meet.
  Bvh surfaceAround(const Vec3& center, double width) const {
    std::vector<Index> triangles;
    for (Index t = 0; t < mesh_.triangleCount(); ++t) {
      Box box;
      for (const Index v : mesh_.triangles[t]) box.add(mesh_.position(v));
      if ((center.cwiseMax(box.min).cwiseMin(box.max) - center).squaredNorm() <= width * width) triangles.push_back(t);
    }
    return Bvh(mesh_, triangles);
  }

  // Shrinks a ball that touches the surface at `start` until it meets no other point of the surface.
  static Sphere ballBehind(const Vec3& start, const Vec3& inwards, double radius, const Bvh& surface) {
    Sphere ball = {start, radius};
    for (int step = 0; step < kMaxShrinks; ++step) {
      ball.center = start + ball.radius * inwards;
      const SurfacePoint nearest = surface.nearestPoint(ball.center);
      if (nearest.distance > (1 - kTouches) * ball.radius) break;
      const Vec3 chord = nearest.position - start;
      ball.radius = chord.squaredNorm() / (2 * chord.dot(inwards));
    }
    return ball;
  }

  const TriMesh& mesh_;
  std::span<const Index> sphereOf_;
};

Vec3 mirrored(const Vec3& point, const MirrorPlane& plane) {
  return point - 2 * heightOver(plane, point) * plane.normal;
}

// One of a pair keeps to its side, so far that it does not meet its image at once.
bool staysApart(const MirrorPlane& plane, const Vec3& before, const Sphere& moved) {
  const double height = heightOver(plane, moved.center);
  return height * heightOver(plane, before) > 0 && std::abs(height) >= 0.5 * moved.radius;
}

}  // namespace

void moveSpheresInside(SphereMeshLevel& level, const TriMesh& mesh, std::span<const Index> sphereOf,
                       const std::optional<MirrorPlane>& mirror) {
  if (mesh.triangles.empty()) return;
  SphereMover mover(mesh, sphereOf);
  std::vector<Vec3> centers;
  for (const Sphere& sphere : level.spheres) centers.push_back(sphere.center);
  const std::vector<bool> inside = areInside(mesh, centers);
  for (Index h = 0; h < level.spheres.size(); ++h) {
    const Index image = level.images.empty() ? kNoIndex : level.images[h];
    if (image < h || inside[h]) continue;
    const bool isOnPlane = image == h;
    std::optional<Sphere> moved = mover.inPartOf(h, isOnPlane ? mirror : std::nullopt);
    if (moved && isOnPlane) {
      moved->center = 0.5 * (moved->center + mirrored(moved->center, *mirror));
      if (!mover.isInside(moved->center)) moved.reset();
    }
    const bool isOfPair = image != kNoIndex && !isOnPlane;
    if (moved && isOfPair && !staysApart(*mirror, level.spheres[h].center, *moved)) moved.reset();
    if (!moved) continue;
    level.spheres[h] = *moved;
    if (isOfPair) level.spheres[image] = {mirrored(moved->center, *mirror), moved->radius};
  }
}

}  // namespace limber
