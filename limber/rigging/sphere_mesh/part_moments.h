// How a part of a surface spreads in space.
#pragma once

#include "limber/core/types.h"

namespace limber {

// Sums over the points of a part, each weighted; additive, as SphereQuadric is.
struct PartMoments {
  double weight = 0;
  double first[3] = {};   // x y z
  double second[6] = {};  // xx xy xz yy yz zz

  void addPoint(const Vec3& point, double weight);
  PartMoments& operator+=(const PartMoments& other) {
    weight += other.weight;
    for (int i = 0; i < 3; ++i) first[i] += other.first[i];
    for (int i = 0; i < 6; ++i) second[i] += other.second[i];
    return *this;
  }
  PartMoments& operator-=(const PartMoments& part) {
    weight -= part.weight;
    for (int i = 0; i < 3; ++i) first[i] -= part.first[i];
    for (int i = 0; i < 6; ++i) second[i] -= part.second[i];
    return *this;
  }

  // As in SphereQuadric.
  void clearOdd();
  PartMoments mirrored() const;
  PartMoments withMirrorImage() const;

  // Weighted sum of squared distances from `center`.
  double squaredDistances(const Vec3& center) const;

  // The largest radius that a sphere for this part should have: 1.5 sqrt(3 v), v being the variance along the direction
  // in which the part is thinnest. That is one and a half times the radius for a whole sphere, three quarters of it for
  // a hemisphere (as three quarters of the least width are, the bound of Thiery, Guy, Boubekeur), and 0 for a flat
  // part.
  double radiusBound() const;
};

}  // namespace limber
