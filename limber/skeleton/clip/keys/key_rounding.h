// How exactly the times of keys are known.
#pragma once

#include <cmath>
#include <limits>

namespace limber {

// Keys have times in single precision, frames in double: k / 60 as a key may lie a little after k / 60 as a frame. A
// key of a constant track therefore counts from this much before its time on. In seconds, at a time in seconds.
inline double keyRounding(double seconds) {
  return 4 * std::numeric_limits<float>::epsilon() * std::abs(seconds);
}

// A moment before the time of a key, at which that key of a constant track does not count yet.
inline double justBefore(double keySeconds) {
  return keySeconds - 2 * keyRounding(keySeconds);
}

}  // namespace limber
