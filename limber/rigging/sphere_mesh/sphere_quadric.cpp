#include "limber/rigging/sphere_mesh/sphere_quadric.h"

#include <algorithm>

namespace limber {

namespace {

// The terms that change sign when x does: xy, xz, xr and b_x.
constexpr int kOddTerms[] = {1, 2, 3, 10};

// A = L D L' and y = L^-1 b. The radius comes last, so that leaving out its row gives the minimum at r = 0.
struct Factor {
  double l10, l20, l30, l21, l31, l32;
  double inverse0, inverse1, inverse2, inverse3;
  double y0, y1, y2, y3;

  explicit Factor(const double* q) {
    inverse0 = 1 / q[0];
    l10 = q[1] * inverse0;
    l20 = q[2] * inverse0;
    l30 = q[3] * inverse0;
    const double a11 = q[4] - l10 * q[1];
    const double a12 = q[5] - l10 * q[2];
    const double a13 = q[6] - l10 * q[3];
    inverse1 = 1 / a11;
    l21 = a12 * inverse1;
    l31 = a13 * inverse1;
    const double a22 = q[7] - l20 * q[2] - l21 * a12;
    const double a23 = q[8] - l20 * q[3] - l21 * a13;
    inverse2 = 1 / a22;
    l32 = a23 * inverse2;
    inverse3 = 1 / (q[9] - l30 * q[3] - l31 * a13 - l32 * a23);
    y0 = q[10];
    y1 = q[11] - l10 * y0;
    y2 = q[12] - l20 * y0 - l21 * y1;
    y3 = q[13] - l30 * y0 - l31 * y1 - l32 * y2;
  }

  // The minimum for a given radius.
  Sphere sphere(double r) const {
    const double z = y2 * inverse2 - l32 * r;
    const double y = y1 * inverse1 - l21 * z - l31 * r;
    const double x = y0 * inverse0 - l10 * y - l20 * z - l30 * r;
    return {Vec3(x, y, z), r};
  }
};

double minError(const double* terms) {
  const Factor f(terms);
  double error = terms[14] - f.y0 * f.y0 * f.inverse0 - f.y1 * f.y1 * f.inverse1 - f.y2 * f.y2 * f.inverse2;
  if (f.y3 > 0) error -= f.y3 * f.y3 * f.inverse3;
  return std::max(error, 0.0);
}

}  // namespace

void SphereQuadric::addPlane(const Vec3& point, const Vec3& normal, double weight) {
  const double nx = normal.x(), ny = normal.y(), nz = normal.z();
  const double height = nx * point.x() + ny * point.y() + nz * point.z();
  const double pull = kCentering * weight;
  const double added[kTerms] = {weight * nx * nx + pull,
                                weight * nx * ny,
                                weight * nx * nz,
                                weight * nx,
                                weight * ny * ny + pull,
                                weight * ny * nz,
                                weight * ny,
                                weight * nz * nz + pull,
                                weight * nz,
                                weight,
                                weight * height * nx + pull * point.x(),
                                weight * height * ny + pull * point.y(),
                                weight * height * nz + pull * point.z(),
                                weight * height,
                                weight * height * height + pull * point.squaredNorm()};
  for (int i = 0; i < kTerms; ++i) terms[i] += added[i];
}

void SphereQuadric::addPoint(const Vec3& point, double weight) {
  addPlane(point, Vec3::Zero(), weight);
}

void SphereQuadric::clearOdd() {
  for (const int i : kOddTerms) terms[i] = 0;
}

SphereQuadric SphereQuadric::mirrored() const {
  SphereQuadric result = *this;
  for (const int i : kOddTerms) result.terms[i] = -result.terms[i];
  return result;
}

SphereQuadric SphereQuadric::withMirrorImage() const {
  SphereQuadric result;
  for (int i = 0; i < kTerms; ++i) result.terms[i] = 2 * terms[i];
  result.clearOdd();
  return result;
}

double SphereQuadric::error(const Sphere& sphere) const {
  const double x = sphere.center.x(), y = sphere.center.y(), z = sphere.center.z(), r = sphere.radius;
  const double* q = terms;
  const double ax = q[0] * x + 2 * (q[1] * y + q[2] * z + q[3] * r - q[10]);
  const double ay = q[4] * y + 2 * (q[5] * z + q[6] * r - q[11]);
  const double az = q[7] * z + 2 * (q[8] * r - q[12]);
  const double ar = q[9] * r - 2 * q[13];
  return x * ax + y * ay + z * az + r * ar + q[14];
}

double SphereQuadric::minimumError() const {
  return minError(terms);
}

double SphereQuadric::jointMinimumError(const SphereQuadric& a, const SphereQuadric& b) {
  double sum[kTerms];
  for (int i = 0; i < kTerms; ++i) sum[i] = a.terms[i] + b.terms[i];
  return minError(sum);
}

Sphere SphereQuadric::minimum() const {
  const Factor f(terms);
  return f.sphere(std::max(f.y3 * f.inverse3, 0.0));
}

Sphere SphereQuadric::minimumOfRadius(double radius) const {
  return Factor(terms).sphere(radius);
}

}  // namespace limber
