// Ways between two states that start and end smoothly.
#pragma once

namespace limber {

// The polynomial of degree 5 from `from`, where it has that speed and acceleration, to `to`, where it rests; `share`
// 0 to 1. Speed and acceleration per whole way.
template <typename Value>
Value smoothWay(const Value& from, const Value& speed, const Value& acceleration, const Value& to, double share) {
  const double s = share, s2 = s * s, s3 = s2 * s;
  const Value way = to - from;
  return from + s * speed + 0.5 * s2 * acceleration + s3 * (10 * way - 6 * speed - 1.5 * acceleration) +
         s3 * s * (-15 * way + 8 * speed + 1.5 * acceleration) + s3 * s2 * (6 * way - 3 * speed - 0.5 * acceleration);
}

// 0 to 1 for x from 0 to 1, and resting there.
inline double smoothRise(double x) {
  const double s = x < 0 ? 0 : x > 1 ? 1 : x;
  return s * s * s * (10 - 15 * s + 6 * s * s);
}

// 0 at 0 and 1, where it rests, and 1 between.
inline double smoothBump(double x) {
  if (x <= 0 || x >= 1) return 0;
  const double s = 4 * x * (1 - x);
  return s * s * s;
}

}  // namespace limber
