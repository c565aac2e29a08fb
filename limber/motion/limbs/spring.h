// Critically damped springs: what follows comes to rest where it is drawn to, without swinging over.
#pragma once

#include <cmath>

#include "limber/core/types.h"

namespace limber {

// Draws `value`, which moves at `speed`, towards `target` for `seconds`; `rate` in 1/seconds. The exact motion while
// `target` rests, whatever the step; its speed never jumps. No time puts it there, at rest. `Value`: double or a
// vector.
template <typename Value>
void springTo(const Value& target, double rate, double seconds, Value& value, Value& speed) {
  if (seconds <= 0) {
    value = target;
    speed *= 0;
    return;
  }
  const double fade = std::exp(-rate * seconds);
  const Value off = value - target, pull = speed + rate * off;
  value = target + fade * (off + seconds * pull);
  speed = fade * (speed - rate * seconds * pull);
}

// A number that is drawn so.
struct SprungNumber {
  double value = 0, speed = 0;

  void drawTo(double target, double rate, double seconds) { springTo(target, rate, seconds, value, speed); }
};

// A vector that is drawn so, at rest at the origin.
struct Sprung {
  Vec3 value = Vec3::Zero(), speed = Vec3::Zero();

  void drawTo(const Vec3& target, double rate, double seconds) { springTo(target, rate, seconds, value, speed); }
};

}  // namespace limber
