#include "limber/skeleton/ik/limits/limits.h"

#include <algorithm>
#include <cmath>

#include "limber/core/rotation.h"

namespace limber {

namespace {

using Eigen::Vector2d;

constexpr double kSameAngle = 1e-12;

Quat aboutX(double angle) {
  return Quat(std::cos(angle / 2), std::sin(angle / 2), 0, 0);
}

Quat aboutY(double angle) {
  return Quat(std::cos(angle / 2), 0, std::sin(angle / 2), 0);
}

Quat aboutZ(double angle) {
  return Quat(std::cos(angle / 2), 0, 0, std::sin(angle / 2));
}

// The angle of the range nearest to `angle` round the circle; `angle` itself, perhaps whole turns away, if within.
double clampAngle(double angle, const AngleRange& range) {
  const double half = (range.max - range.min) / 2;
  const double middle = range.min + half;
  return middle + std::clamp(wrapAngle(angle - middle), -half, half);
}

bool sameAngle(double a, double b) {
  return std::abs(wrapAngle(a - b)) <= kSameAngle;
}

// r = swing * twist: the twist about Y first, then the swing about an axis in the plane of X and Z.
struct SwingAndTwist {
  Vector2d swing;  // rotation vector (x, z), length at most pi
  double twist;    // in (-pi, pi]
};

SwingAndTwist splitSwingTwist(const Quat& r) {
  const double cosHalfSwing = std::sqrt(r.w() * r.w() + r.y() * r.y());
  // Swung by half a turn every twist is as good as another; none is taken.
  const double c = cosHalfSwing > 1e-12 ? r.w() / cosHalfSwing : 1;
  const double s = cosHalfSwing > 1e-12 ? r.y() / cosHalfSwing : 0;
  const Vector2d v(c * r.x() + s * r.z(), c * r.z() - s * r.x());
  const double sinHalfSwing = v.norm();
  const double angle = 2 * std::atan2(sinHalfSwing, cosHalfSwing);
  SwingAndTwist parts;
  parts.swing = sinHalfSwing > 1e-12 ? Vector2d(angle / sinHalfSwing * v) : Vector2d(2 * v);
  parts.twist = wrapAngle(2 * std::atan2(s, c));
  return parts;
}

Quat compose(const SwingAndTwist& parts) {
  return fromRotationVector(Vec3(parts.swing.x(), 0, parts.swing.y())) * aboutY(parts.twist);
}

// The twist part of r about a unit axis, as an angle.
double angleAbout(const Vec3& axis, const Quat& r) {
  return 2 * std::atan2(r.vec().dot(axis), r.w());
}

Quat nearestHinge(const Vec3& axis, const AngleRange& range, const Quat& r) {
  const double nearest = clampAngle(angleAbout(axis, r), range);
  return Quat(Eigen::AngleAxisd(nearest, axis));
}

// The nearest aboutZ(b) * aboutX(a). Its product with r is u^T M v with u, v the cosines and sines of a / 2 and b / 2,
// largest for M's first singular vectors; where those are not allowed, the best lies on an edge.
Quat nearestSaddle(const Saddle& saddle, const Quat& r) {
  const double e = (r.w() + r.y()) / 2, f = (r.w() - r.y()) / 2;
  const double g = (r.x() + r.z()) / 2, h = (r.x() - r.z()) / 2;
  const double freeA = std::atan2(g, f) + std::atan2(h, e);
  const double freeB = std::atan2(g, f) - std::atan2(h, e);
  double bestA = clampAngle(freeA, saddle.x), bestB = clampAngle(freeB, saddle.z);
  if (sameAngle(bestA, freeA) && sameAngle(bestB, freeB)) return aboutZ(bestB) * aboutX(bestA);

  double best = -1;
  const auto consider = [&](double a, double b) {
    const double product = std::abs((aboutZ(b) * aboutX(a)).dot(r));
    if (product > best) best = product, bestA = a, bestB = b;
  };
  for (const double a : {saddle.x.min, saddle.x.max}) {
    const double c = std::cos(a / 2), s = std::sin(a / 2);
    consider(a, clampAngle(2 * std::atan2(c * r.z() + s * r.y(), c * r.w() + s * r.x()), saddle.z));
  }
  for (const double b : {saddle.z.min, saddle.z.max}) {
    const double c = std::cos(b / 2), s = std::sin(b / 2);
    consider(clampAngle(2 * std::atan2(c * r.x() + s * r.y(), c * r.w() + s * r.z()), saddle.x), b);
  }
  return aboutZ(bestB) * aboutX(bestA);
}

// The nearest rotation allowed, in the limit's axes; one overload for each kind of joint.
struct Nearest {
  Quat r;

  Quat operator()(const FreeJoint&) const { return r; }
  Quat operator()(const FixedJoint&) const { return Quat::Identity(); }
  Quat operator()(const PlaneJoint&) const { return Quat::Identity(); }
  Quat operator()(const Hinge& hinge) const { return nearestHinge(Vec3::UnitX(), hinge.x, r); }
  Quat operator()(const Pivot& pivot) const { return nearestHinge(Vec3::UnitY(), pivot.y, r); }
  Quat operator()(const Saddle& saddle) const { return nearestSaddle(saddle, r); }
  Quat operator()(const BallAndSocket& ball) const { return cone(ball.x, ball.z, ball.twist); }
  Quat operator()(const Condyloid& condyloid) const { return cone(condyloid.x, condyloid.z, {0, 0}); }

  Quat operator()(const SwingTwist& limit) const {
    SwingAndTwist parts = splitSwingTwist(r);
    parts.swing.x() = std::clamp(parts.swing.x(), limit.x.min, limit.x.max);
    parts.swing.y() = std::clamp(parts.swing.y(), limit.z.min, limit.z.max);
    parts.twist = clampAngle(parts.twist, limit.twist);
    return compose(parts);
  }

  Quat operator()(const ReachCone& limit) const {
    const Vec3 bone = nearestInReachCone(limit, r * Vec3(Vec3::UnitY()));
    const double twist = clampAngle(splitSwingTwist(r).twist, limit.twist);
    return shortestRotation(Vec3::UnitY(), bone) * aboutY(twist);
  }

 private:
  Quat cone(const AngleRange& x, const AngleRange& z, const AngleRange& twist) const {
    const SwingAndTwist parts = splitSwingTwist(r);
    return compose({nearestInEllipses(x, z, parts.swing), clampAngle(parts.twist, twist)});
  }
};

bool isOpen(const AngleRange& range) {
  return range.max - range.min > 1e-9;
}

// Axes of coordinates r = swing(x, z) * aboutY(twist) as rotations of the bone's own frame. Those whose range is a
// single angle are left out.
TurnAxes swingTwistAxes(bool x, bool z, bool twist, const Quat& r) {
  TurnAxes result;
  if (x && z && twist) {
    result.axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    result.count = 3;
    return result;
  }
  const SwingAndTwist parts = splitSwingTwist(r);
  const Vec3 swing(parts.swing.x(), 0, parts.swing.y());
  const double angle = swing.norm();
  // The right Jacobian of the exponential map: how the swung frame turns when the swing's rotation vector changes.
  const double c1 = angle < 1e-4 ? 0.5 : (1 - std::cos(angle)) / (angle * angle);
  const double c2 = angle < 1e-4 ? 1.0 / 6 : (angle - std::sin(angle)) / (angle * angle * angle);
  const Quat untwist = aboutY(-parts.twist);
  const auto add = [&](const Vec3& axis) {
    const Vec3 once = swing.cross(axis);
    const Vec3 turned = untwist * Vec3(axis - c1 * once + c2 * swing.cross(once));
    result.axes[static_cast<std::size_t>(result.count++)] = turned.normalized();
  };
  if (x) add(Vec3::UnitX());
  if (z) add(Vec3::UnitZ());
  if (twist) result.axes[static_cast<std::size_t>(result.count++)] = Vec3::UnitY();
  return result;
}

struct Axes {
  Quat r;

  TurnAxes operator()(const FreeJoint&) const { return swingTwistAxes(true, true, true, r); }
  TurnAxes operator()(const FixedJoint&) const { return {}; }
  TurnAxes operator()(const PlaneJoint&) const { return {}; }
  TurnAxes operator()(const Hinge& hinge) const { return one(Vec3::UnitX(), hinge.x); }
  TurnAxes operator()(const Pivot& pivot) const { return one(Vec3::UnitY(), pivot.y); }
  TurnAxes operator()(const BallAndSocket& l) const {
    return swingTwistAxes(isOpen(l.x), isOpen(l.z), isOpen(l.twist), r);
  }
  TurnAxes operator()(const Condyloid& l) const { return swingTwistAxes(isOpen(l.x), isOpen(l.z), false, r); }
  TurnAxes operator()(const SwingTwist& l) const {
    return swingTwistAxes(isOpen(l.x), isOpen(l.z), isOpen(l.twist), r);
  }
  TurnAxes operator()(const ReachCone& l) const { return swingTwistAxes(true, true, isOpen(l.twist), r); }

  TurnAxes operator()(const Saddle& saddle) const {
    TurnAxes result;
    if (isOpen(saddle.x)) result.axes[static_cast<std::size_t>(result.count++)] = Vec3::UnitX();
    if (isOpen(saddle.z)) {
      const Quat back = aboutX(-angleAbout(Vec3::UnitX(), r));
      result.axes[static_cast<std::size_t>(result.count++)] = back * Vec3(Vec3::UnitZ());
    }
    return result;
  }

 private:
  static TurnAxes one(const Vec3& axis, const AngleRange& range) {
    TurnAxes result;
    if (isOpen(range)) result.axes[static_cast<std::size_t>(result.count++)] = axis;
    return result;
  }
};

double between(const AngleRange& range, double fraction) {
  return range.min + fraction * (range.max - range.min);
}

struct Sample {
  Vec3 u;

  Quat operator()(const FreeJoint&) const {  // Shoemake: uniform over all rotations
    const double a = std::sqrt(1 - u.x()), b = std::sqrt(u.x());
    const double s = 2 * kPi * u.y(), t = 2 * kPi * u.z();
    return Quat(b * std::cos(t), a * std::sin(s), a * std::cos(s), b * std::sin(t));
  }
  Quat operator()(const FixedJoint&) const { return Quat::Identity(); }
  Quat operator()(const PlaneJoint&) const { return Quat::Identity(); }
  Quat operator()(const Hinge& hinge) const { return aboutX(between(hinge.x, u.x())); }
  Quat operator()(const Pivot& pivot) const { return aboutY(between(pivot.y, u.x())); }
  Quat operator()(const Saddle& s) const { return aboutZ(between(s.z, u.y())) * aboutX(between(s.x, u.x())); }
  Quat operator()(const BallAndSocket& ball) const { return cone(ball.x, ball.z, ball.twist); }
  Quat operator()(const Condyloid& condyloid) const { return cone(condyloid.x, condyloid.z, {0, 0}); }
  Quat operator()(const SwingTwist& l) const {
    return compose({Vector2d(between(l.x, u.x()), between(l.z, u.y())), between(l.twist, u.z())});
  }
  Quat operator()(const ReachCone& l) const {
    const double scaled = u.x() * static_cast<double>(l.polygon.size());
    const std::size_t i = std::min(static_cast<std::size_t>(scaled), l.polygon.size() - 1);
    const double along = scaled - static_cast<double>(i), out = std::sqrt(u.y());
    const Vec3 a = l.polygon[i].normalized(), b = l.polygon[(i + 1) % l.polygon.size()].normalized();
    const Vec3 bone = (1 - out) * l.center + out * ((1 - along) * a + along * b);
    return shortestRotation(Vec3::UnitY(), bone) * aboutY(between(l.twist, u.z()));
  }

 private:
  Quat cone(const AngleRange& x, const AngleRange& z, const AngleRange& twist) const {
    const double out = std::sqrt(u.x()), c = std::cos(2 * kPi * u.y()), s = std::sin(2 * kPi * u.y());
    const Vector2d swing(out * c * (c < 0 ? -x.min : x.max), out * s * (s < 0 ? -z.min : z.max));
    return compose({swing, between(twist, u.z())});
  }
};

Quat toLimitAxes(const JointLimit& limit, const Quat& local) {
  return limit.axes.conjugate() * limit.neutral.conjugate() * local * limit.axes;
}

Quat fromLimitAxes(const JointLimit& limit, const Quat& r) {
  return (limit.neutral * limit.axes * r * limit.axes.conjugate()).normalized();
}

}  // namespace

Quat nearestAllowed(const JointLimit& limit, const Quat& local) {
  if (std::holds_alternative<FreeJoint>(limit.motion)) return local;
  const Quat r = toLimitAxes(limit, local).normalized();
  const Quat nearest = std::visit(Nearest{r}, limit.motion);
  const double gap =
      std::min((nearest.coeffs() - r.coeffs()).squaredNorm(), (nearest.coeffs() + r.coeffs()).squaredNorm());
  return gap <= kSameAngle * kSameAngle ? local : fromLimitAxes(limit, nearest);
}

Vec3 nearestAllowedTranslation(const JointLimit& limit, const Vec3& local) {
  const PlaneJoint* plane = std::get_if<PlaneJoint>(&limit.motion);
  if (!plane) return local;
  const Quat toParent = limit.neutral * limit.axes;
  const Vec3 offset = toParent.conjugate() * Vec3(local - limit.restTranslation);
  const Vec3 nearest(std::clamp(offset.x(), plane->x.min, plane->x.max), 0,
                     std::clamp(offset.z(), plane->z.min, plane->z.max));
  return limit.restTranslation + toParent * nearest;
}

double limitViolation(const JointLimit& limit, const Quat& local) {
  return angleBetween(local, nearestAllowed(limit, local));
}

TurnAxes turnAxes(const JointLimit& limit, const Quat& local) {
  TurnAxes result = std::visit(Axes{toLimitAxes(limit, local)}, limit.motion);
  for (Vec3& axis : result.axes) axis = limit.axes * axis;
  return result;
}

Quat allowedRotation(const JointLimit& limit, const Vec3& uniform) {
  return fromLimitAxes(limit, std::visit(Sample{uniform}, limit.motion));
}

}  // namespace limber
