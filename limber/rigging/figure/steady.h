// Functions with the same bits in every library: a search by comparisons takes another path where one bit differs.
#pragma once

#include <cmath>

#include "limber/core/types.h"

namespace limber {

// On a grid that is much coarser than what libraries differ by, and much finer than what matters.
inline double onGrid(double x) {
  return std::round(x * 0x1p30) * 0x1p-30;
}

struct SteadyAngle {
  double cos, sin;
  explicit SteadyAngle(double radians) : cos(onGrid(std::cos(radians))), sin(onGrid(std::sin(radians))) {}
};

// Nearly the logarithm of a ratio near 1, by division alone.
inline double ratioOff(double ratio) {
  return 0.5 * (ratio - 1 / ratio);
}

// A ratio that is off by `by`, nearly its exponential; ratioFor(-by) is its inverse.
inline double ratioFor(double by) {
  return by >= 0 ? 1 + by : 1 / (1 - by);
}

// A turn about an axis by its length in radians, nearly (Cayley's map): by a root alone.
inline Mat3 turnBy(const Vec3& turn) {
  const Vec3 half = 0.5 * turn;
  return Quat(1, half.x(), half.y(), half.z()).normalized().toRotationMatrix();
}

}  // namespace limber
