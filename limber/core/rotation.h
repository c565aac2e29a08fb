// Rotations as vectors, their angles, and the one that takes a direction to another. Angles in radians.
#pragma once

#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/core/types.h"

namespace limber {

// The rotation by |v| about v.
inline Quat fromRotationVector(const Vec3& v) {
  const double angle2 = v.squaredNorm();
  // Series of sin(x/2)/x: exact to double precision for small angles, where the quotient would lose it.
  if (angle2 < 1e-6) {
    const double factor = 0.5 - angle2 / 48;
    return Quat(1 - angle2 / 8 + angle2 * angle2 / 384, factor * v.x(), factor * v.y(), factor * v.z());
  }
  const double angle = std::sqrt(angle2);
  const double factor = std::sin(angle / 2) / angle;
  return Quat(std::cos(angle / 2), factor * v.x(), factor * v.y(), factor * v.z());
}

// The rotation vector of length at most pi. q is of unit length.
inline Vec3 toRotationVector(const Quat& q) {
  const double length = q.vec().norm();
  if (length < 1e-12) return (q.w() < 0 ? -2.0 : 2.0) * q.vec();
  const double angle = 2 * std::atan2(length, std::abs(q.w()));
  return (q.w() < 0 ? -angle : angle) / length * q.vec();
}

// The angle of the rotation from a to b, in [0, pi], exact near 0.
inline double angleBetween(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

// The smallest rotation that takes the direction of `from` to that of `to`; neither has length 0. Opposite directions
// turn about an axis that depends on `from` only.
inline Quat shortestRotation(const Vec3& from, const Vec3& to) {
  const double lengths = std::sqrt(from.squaredNorm() * to.squaredNorm());
  const double w = lengths + from.dot(to);
  if (w > 1e-14 * lengths) {
    const Vec3 axis = from.cross(to);
    const double scale = 1 / std::sqrt(w * w + axis.squaredNorm());
    return Quat(w * scale, axis.x() * scale, axis.y() * scale, axis.z() * scale);
  }
  Eigen::Index smallest = 0;
  from.cwiseAbs().minCoeff(&smallest);
  const Vec3 axis = from.cross(Vec3(Vec3::Unit(smallest))).normalized();
  return Quat(0, axis.x(), axis.y(), axis.z());
}

// Angle in (-pi, pi] that differs from `angle` by whole turns.
inline double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

}  // namespace limber
