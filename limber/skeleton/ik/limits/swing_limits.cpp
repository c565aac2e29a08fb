// Nearest points of the two limits whose edge is a curve: the elliptic cone and the reach cone.
#include <algorithm>
#include <cmath>

#include "limber/skeleton/ik/limits/limits.h"

namespace limber {

namespace {

constexpr double kInside = 1e-12;

// The point nearest to (x, z), outside and in the first quadrant, of the ellipse with half axes a, b > 0. With the
// multiplier t the point is (a^2 x / (t + a^2), b^2 z / (t + b^2)); the equation for t is convex and falling, so that
// Newton's method from the left of the root climbs to it without overshoot.
Eigen::Vector2d nearestOnQuarter(double a, double b, double x, double z) {
  const double a2 = a * a, b2 = b * b;
  double t = std::max({0.0, a * x - a2, b * z - b2});
  for (int i = 0; i < 60; ++i) {
    const double p = a * x / (t + a2), q = b * z / (t + b2);
    const double value = p * p + q * q - 1;
    const double slope = -2 * (p * p / (t + a2) + q * q / (t + b2));
    const double next = t - value / slope;
    if (!(next > t * (1 + 1e-16)) || value <= 0) break;
    t = next;
  }
  return {a2 * x / (t + a2), b2 * z / (t + b2)};
}

// The point of the arc from unit vector u to unit vector v (less than half a turn) nearest to d.
Vec3 nearestOnArc(const Vec3& u, const Vec3& v, const Vec3& d) {
  const Vec3 normal = u.cross(v);
  const Vec3 inPlane = d - d.dot(normal) / normal.squaredNorm() * normal;
  const bool within = u.cross(inPlane).dot(normal) >= 0 && inPlane.cross(v).dot(normal) >= 0;
  if (within && inPlane.squaredNorm() > 0) return inPlane.normalized();
  return d.dot(u) >= d.dot(v) ? u : v;
}

bool inTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return d.dot(a.cross(b)) >= -kInside && d.dot(b.cross(c)) >= -kInside && d.dot(c.cross(a)) >= -kInside;
}

}  // namespace

Eigen::Vector2d nearestInEllipses(const AngleRange& x, const AngleRange& z, const Eigen::Vector2d& point) {
  const double a = point.x() < 0 ? -x.min : x.max;
  const double b = point.y() < 0 ? -z.min : z.max;
  const double px = std::abs(point.x()), pz = std::abs(point.y());
  Eigen::Vector2d nearest;
  if (a <= 0 || b <= 0) {
    nearest = {std::min(px, std::max(a, 0.0)), std::min(pz, std::max(b, 0.0))};
  } else if (px * px / (a * a) + pz * pz / (b * b) <= 1 + kInside) {
    return point;
  } else {
    nearest = nearestOnQuarter(a, b, px, pz);
  }
  return {std::copysign(nearest.x(), point.x()), std::copysign(nearest.y(), point.y())};
}

Vec3 nearestInReachCone(const ReachCone& cone, const Vec3& direction) {
  const std::size_t count = cone.polygon.size();
  Vec3 nearest = direction;
  double best = -2;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 u = cone.polygon[i].normalized();
    const Vec3 v = cone.polygon[(i + 1) % count].normalized();
    if (inTriangle(cone.center, u, v, direction)) return direction;
    const Vec3 candidate = nearestOnArc(u, v, direction);
    if (candidate.dot(direction) > best) {
      best = candidate.dot(direction);
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace limber
