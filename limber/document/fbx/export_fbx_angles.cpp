#include "limber/document/fbx/export_fbx_angles.h"

#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

// Closer to the pole than this (the cosine of the angle about y), the turns about x and z are one.
constexpr double kAtPole = 1e-8;

Vec3 roundedDegrees(const Vec3& degrees) {
  return degrees.cast<float>().cast<double>();
}

Vec3 unrolledDegrees(const Vec3& degrees, const Vec3& before) {
  Vec3 near = degrees;
  for (int axis = 0; axis < 3; ++axis) near[axis] += 360 * std::round((before[axis] - near[axis]) / 360);
  return near;
}

}  // namespace

Vec3 eulerDegrees(const Quat& rotation) {
  const Mat3 m = rotation.normalized().toRotationMatrix();
  const double cosine = std::hypot(m(0, 0), m(1, 0));
  const double y = std::atan2(-m(2, 0), cosine);
  if (cosine < kAtPole) return roundedDegrees(Vec3(std::atan2(-m(1, 2), m(1, 1)), y, 0) / kDegree);
  return roundedDegrees(Vec3(std::atan2(m(2, 1), m(2, 2)), y, std::atan2(m(1, 0), m(0, 0))) / kDegree);
}

Vec3 eulerDegreesNear(const Quat& rotation, const Vec3& before) {
  Vec3 first = eulerDegrees(rotation);
  if (rotation.normalized().toRotationMatrix().topLeftCorner<2, 1>().norm() < kAtPole) {
    // All of the turn about z can be given to x: as much as before, the rest to x.
    const double sign = first.y() > 0 ? 1 : -1;
    first = Vec3(first.x() + sign * before.z(), first.y(), before.z());
  }
  const Vec3 second(first.x() + 180, 180 - first.y(), first.z() + 180);
  const Vec3 a = unrolledDegrees(first, before), b = unrolledDegrees(second, before);
  return roundedDegrees((a - before).squaredNorm() <= (b - before).squaredNorm() ? a : b);
}

Quat eulerRotation(const Vec3& degrees) {
  return Eigen::AngleAxisd(degrees.z() * kDegree, Vec3::UnitZ()) *
         Eigen::AngleAxisd(degrees.y() * kDegree, Vec3::UnitY()) *
         Eigen::AngleAxisd(degrees.x() * kDegree, Vec3::UnitX());
}

}  // namespace limber
