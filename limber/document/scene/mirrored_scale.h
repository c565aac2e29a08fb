// Negative scales as decompose() has them, for tracks that know nothing of each other.
#pragma once

#include "limber/core/transform.h"

namespace limber {

// The diagonal of the half turn H (or none) that leaves of a scale S at most x mirrored: R S = (R H) (H S) for every
// rotation R, and H S is what decompose() finds of R S. A scale of 0 counts as not mirrored.
inline Vec3 halfTurnOfMirror(const Vec3& scale) {
  const Vec3 sign = scale.unaryExpr([](double component) { return component < 0 ? -1.0 : 1.0; });
  return {sign.prod() * sign.x(), sign.y(), sign.z()};
}

// The same map in other numbers: R H and H S. Twice is none.
inline Transform turnedMirror(Transform transform, const Vec3& half) {
  transform.rotation = transform.rotation * Quat(Mat3(half.asDiagonal()));
  transform.scale = transform.scale.cwiseProduct(half);
  return transform;
}

}  // namespace limber
