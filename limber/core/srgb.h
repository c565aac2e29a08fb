// The curve of sRGB (IEC 61966-2-1), for single components.
#pragma once

#include <cmath>

namespace limber {

// Results are rounded to float: powers of double precision differ in their last bits between the libraries of C, which
// is far below what a float tells apart. So all machines and WebAssembly have the same.
inline double srgbOf(double linear) {
  const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<float>(encoded);
}

inline double linearOf(double srgb) {
  const double decoded = srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
  return static_cast<float>(decoded);
}

}  // namespace limber
