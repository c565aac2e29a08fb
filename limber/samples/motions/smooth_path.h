// Curves between two states that start and end smoothly.
#pragma once

namespace limber {

// A value with its speed and its acceleration, per second.
template <typename Value>
struct Knot {
  Value at, speed, acceleration;
};

// The polynomial of degree 5 (quintic Hermite) between two knots that are `seconds` apart. Between two knots of one
// parabola it is that parabola.
template <typename Value>
Value between(const Knot<Value>& from, const Knot<Value>& to, double seconds, double time) {
  const double s = time / seconds, s2 = s * s, s3 = s2 * s;
  const Value displacement = to.at - from.at, v0 = seconds * from.speed, v1 = seconds * to.speed;
  const Value a0 = seconds * seconds * from.acceleration, a1 = seconds * seconds * to.acceleration;
  return from.at + s * v0 + 0.5 * s2 * a0 + s3 * (10 * displacement - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1) +
         s3 * s * (-15 * displacement + 8 * v0 + 7 * v1 + 1.5 * a0 - a1) +
         s3 * s2 * (6 * displacement - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1);
}

// From `from`, where it has that speed and acceleration, to `to`, where it rests; `fraction` 0 to 1. The unit of time
// of speed and acceleration is the whole path's duration.
template <typename Value>
Value smoothPath(const Value& from, const Value& speed, const Value& acceleration, const Value& to, double fraction) {
  const Value none = 0 * from;
  return between<Value>({from, speed, acceleration}, {to, none, none}, 1, fraction);
}

inline constexpr double kGravity = 9.81;  // metres a second squared

// How high a body is above where it leaves the ground, metres, that is on the ground for the fraction `onGround` of
// each `period` (seconds), pressed down as by a spring, and in free fall for the rest; `phase` 0 to 1 from its landing.
inline double bounceHeight(double phase, double onGround, double period) {
  const double ground = onGround * period, air = period - ground, time = phase * period;
  const Knot<double> landing{0, -0.5 * kGravity * air, -kGravity}, leaving{0, 0.5 * kGravity * air, -kGravity};
  return time < ground ? between(landing, leaving, ground, time) : between(leaving, landing, air, time - ground);
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
