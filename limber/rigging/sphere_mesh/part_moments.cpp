#include "limber/rigging/sphere_mesh/part_moments.h"

#include <algorithm>
#include <cmath>

namespace limber {

namespace {

// The least root of x^3 - a x^2 + b x - c, all of whose roots are real and >= 0: Laguerre's method from 0, which comes
// from below and is all but exact after three steps. Square roots and divisions only, so equal on every machine.
double minRoot(double a, double b, double c) {
  constexpr double kLine = 1e-9;  // two roots are next to nothing: below, rounding would speak
  if (!(b > kLine * a * a)) return 0;
  double x = 0;
  for (int step = 0; step < 3; ++step) {
    const double value = ((x - a) * x + b) * x - c;
    if (!(value < 0)) break;
    const double g = ((3 * x - 2 * a) * x + b) / value;
    const double h = g * g - (6 * x - 2 * a) / value;
    const double root = std::sqrt(std::max(0.0, 2 * (3 * h - g * g)));
    x -= 3 / (g - root);  // g < 0: the larger of the two denominators
  }
  return x;
}

}  // namespace

void PartMoments::addPoint(const Vec3& point, double pointWeight) {
  const double x = point.x(), y = point.y(), z = point.z();
  const double squares[6] = {x * x, x * y, x * z, y * y, y * z, z * z};
  weight += pointWeight;
  for (int i = 0; i < 3; ++i) first[i] += pointWeight * point[i];
  for (int i = 0; i < 6; ++i) second[i] += pointWeight * squares[i];
}

void PartMoments::clearOdd() {
  first[0] = second[1] = second[2] = 0;
}

PartMoments PartMoments::mirrored() const {
  PartMoments result = *this;
  result.first[0] = -first[0];
  result.second[1] = -second[1];
  result.second[2] = -second[2];
  return result;
}

PartMoments PartMoments::withMirrorImage() const {
  PartMoments result = *this;
  result += *this;
  result.clearOdd();
  return result;
}

double PartMoments::squaredDistances(const Vec3& center) const {
  const double cross = first[0] * center.x() + first[1] * center.y() + first[2] * center.z();
  return second[0] + second[3] + second[5] - 2 * cross + weight * center.squaredNorm();
}

double PartMoments::radiusBound() const {
  if (!(weight > 0)) return 0;
  const double x = first[0] / weight, y = first[1] / weight, z = first[2] / weight;
  const double xx = second[0] / weight - x * x, xy = second[1] / weight - x * y, xz = second[2] / weight - x * z;
  const double yy = second[3] / weight - y * y, yz = second[4] / weight - y * z, zz = second[5] / weight - z * z;
  const double minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz;
  const double determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
  return 1.5 * std::sqrt(3 * std::max(0.0, minRoot(xx + yy + zz, minors, determinant)));
}

}  // namespace limber
