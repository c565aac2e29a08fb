// Functions without a kink, where a clamp would have one.
#pragma once

#include <algorithm>
#include <cmath>

namespace limber {

// 0 up to 0, 1 from 1 on.
inline double smoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// x where it is above 0, else 0: at most softness / 2 more.
inline double softPositive(double x, double softness) {
  return 0.5 * (x + std::hypot(x, softness));
}

// Sine; 0.8 to 0.97; for straightenedAsin() of slopes: up to 64 degrees exact; set by hand.
inline constexpr double kMaxExactSine = 0.9;

// asin(x), but straight on from `until` (below 1) and from its opposite: defined everywhere, without a kink or a pole.
inline double straightenedAsin(double x, double until) {
  const double inside = std::clamp(x, -until, until);
  return std::asin(inside) + (x - inside) / std::sqrt(1 - until * until);
}

}  // namespace limber
