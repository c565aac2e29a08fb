#include "limber/actions/rig/body_masses.h"

#include <cmath>

#include "limber/geometry/mesh/areas.h"

namespace limber {

namespace {

// Calls visit(joint, fraction) for each joint that moves a part of the triangle.
template <class Visit>
void forEachInfluence(const SkinWeights& weights, const Triangle& triangle, const Visit& visit) {
  for (const Index corner : triangle) {
    const auto joints = weights.jointsOf(corner);
    const auto influences = weights.weightsOf(corner);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (influences[i] > 0) visit(joints[i], influences[i] / 3.0);
    }
  }
}

}  // namespace

std::vector<PointMass> bodyMasses(const Geometry& geometry, const SkinWeights& weights, const Skeleton& skeleton) {
  const std::size_t count = skeleton.joints.size();
  std::vector<Vec3> middles(count, Vec3::Zero()), moments = middles;
  std::vector<double> areas(count, 0.0), volumes = areas;
  const auto corner = [&](const Triangle& t, std::size_t k) { return Vec3(geometry.positions[t[k]].cast<double>()); };
  for (const Triangle& t : geometry.triangles) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const double area = triangleArea(a, b, c);
    forEachInfluence(weights, t, [&](Index joint, double fraction) {
      areas[joint] += fraction * area;
      middles[joint] += fraction * area * (a + b + c) / 3;
    });
  }
  for (std::size_t j = 0; j < count; ++j) {
    if (areas[j] > 0) middles[j] /= areas[j];
  }
  for (const Triangle& t : geometry.triangles) {
    const Vec3 a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    forEachInfluence(weights, t, [&](Index joint, double fraction) {
      const Vec3& middle = middles[joint];
      const double volume = fraction * (a - middle).dot((b - middle).cross(c - middle)) / 6;
      volumes[joint] += volume;
      moments[joint] += volume * (a + b + c + middle) / 4;
    });
  }
  const std::vector<Affine> bind = restGlobals(skeleton);
  std::vector<PointMass> masses;
  for (std::size_t j = 0; j < count; ++j) {
    if (!(volumes[j] > 0)) continue;
    // Where a surface is open, the middle may come out far from it.
    const Vec3 center = moments[j] / volumes[j];
    const bool isNear = (center - middles[j]).squaredNorm() <= areas[j];
    const Transform frame = decompose(bind[j]);
    const Vec3 offset = frame.rotation.conjugate() * ((isNear ? center : middles[j]) - frame.translation);
    if (offset.allFinite()) masses.push_back({static_cast<Index>(j), offset, volumes[j]});
  }
  return masses;
}

}  // namespace limber
