// How much the limbs of a figure overlap.
#pragma once

#include <array>

#include "limber/rigging/figure/figure.h"

namespace limber {

// The space that a limb takes up: positions along its middle, and the bones beyond its root.
struct LimbSpace {
  struct Sample {
    Vec3 at;
    double thick;
  };
  struct Bone {
    Vec3 from, direction;
    double perLength2, thick;
  };
  std::array<Sample, 8> samples;
  std::array<Bone, 3> bones;
  Vec3 middle;       // of a ball that holds all of it
  double reach = 0;  // radius of that ball
};

LimbSpace spaceOf(const Figure& figure, int limb);

// Of each of both in the other, summed; 0 where they are apart.
double limbOverlap(const LimbSpace& a, const LimbSpace& b);

}  // namespace limber
