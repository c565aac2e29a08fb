// The spherical quadric error of a part of a surface, packed for the inner loop of the collapse.
#pragma once

#include "limber/core/types.h"

namespace limber {

struct Sphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

// A sum of squared signed distances from spheres s = (x, y, z, r) to planes, and of a pull towards points:
//   E(s) = sum_i w_i (n_i . (p_i - c) - r)^2  +  kCentering sum_j w_j |p_j - c|^2  =  s'As - 2 b's + e
// The first sum is the metric of Thiery, Guy, Boubekeur (Sphere-Meshes, 2013, equation 3): zero for the sphere inside a
// surface that touches all of its planes. The second keeps the centre of flat, straight and noisy parts, where the
// first has no single minimum, at the middle of the part. It makes A positive definite whenever a weight is positive,
// so that every minimum is one Cholesky solve; and since the best radius for a centre is the mean of n_i . (p_i - c),
// no radius exceeds the root mean square distance from the centre to the part.
//
// Sums only grow: E(A + B) at its minimum is at least E(A) and at least E(B) at theirs. The collapse relies on that.
struct SphereQuadric {
  static constexpr double kCentering = 0.001;

  // Upper triangle of A by rows (xx xy xz xr yy yz yr zz zr rr), then b, then the constant e.
  static constexpr int kTerms = 15;
  double terms[kTerms] = {};

  // The plane through `point` with unit `normal` (outwards), and the point itself.
  void addPlane(const Vec3& point, const Vec3& normal, double weight);
  // A point without a surface: a sphere of radius 0 there has no error.
  void addPoint(const Vec3& point, double weight);

  SphereQuadric& operator+=(const SphereQuadric& other) {
    for (int i = 0; i < kTerms; ++i) terms[i] += other.terms[i];
    return *this;
  }
  // Takes away what is part of this.
  SphereQuadric& operator-=(const SphereQuadric& part) {
    for (int i = 0; i < kTerms; ++i) terms[i] -= part.terms[i];
    return *this;
  }

  // Sum of the weights.
  double weight() const { return terms[9]; }
  // Sets to 0 what is odd in x: the mean of this and its mirror image, whose minimum lies on the plane x = 0.
  void clearOdd();
  // The same surface mirrored at the plane x = 0.
  SphereQuadric mirrored() const;
  // This and its mirror image; nothing in it is odd in x.
  SphereQuadric withMirrorImage() const;

  double error(const Sphere& sphere) const;
  // Least error over all spheres with r >= 0.
  double minimumError() const;
  Sphere minimum() const;  // where that is
  // The best sphere of that radius.
  Sphere minimumOfRadius(double radius) const;
  // The same of a + b.
  static double jointMinimumError(const SphereQuadric& a, const SphereQuadric& b);
};

}  // namespace limber
