// Constants of mathematics, by short names.
#pragma once

namespace limber {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180;  // in radians

}  // namespace limber
