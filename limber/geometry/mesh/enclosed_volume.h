// What a surface holds.
#pragma once

#include <span>

#include "limber/core/types.h"

namespace limber {

// The volume within triangles that face outwards, negative where they face inwards; of an open surface that of the
// cones from the origin, which depends on where it lies. Cost: O(#F).
inline double enclosedVolume(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
  double six = 0;
  for (const Triangle& t : triangles) {
    const Vec3 a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(),
               c = positions[t[2]].cast<double>();
    six += a.dot(b.cross(c));
  }
  return six / 6;
}

}  // namespace limber
