// Refusing limits that make no sense, with the entry named.
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/limits/limits.h"

namespace limber {

namespace {

constexpr double kLimitRounding = 1e-9;

class LimitChecker {
 public:
  explicit LimitChecker(const std::string& where) : where_(where) {}

  void operator()(const FreeJoint&) const {}
  void operator()(const FixedJoint&) const {}
  void operator()(const Hinge& hinge) const { range("x", hinge.x); }
  void operator()(const Pivot& pivot) const { range("y", pivot.y); }
  void operator()(const Saddle& saddle) const { range("x", saddle.x), range("z", saddle.z); }
  void operator()(const Condyloid& condyloid) const { ellipse("x", condyloid.x), ellipse("z", condyloid.z); }

  void operator()(const BallAndSocket& ball) const {
    ellipse("x", ball.x), ellipse("z", ball.z);
    range("twist", ball.twist);
  }

  void operator()(const SwingTwist& limit) const {
    range("x", limit.x), range("z", limit.z), range("twist", limit.twist);
    const double x = std::max(std::abs(limit.x.min), std::abs(limit.x.max));
    const double z = std::max(std::abs(limit.z.min), std::abs(limit.z.max));
    if (std::hypot(x, z) > kPi + kLimitRounding) bad("swings further than half a turn at a corner of x and z");
  }

  void operator()(const ReachCone& cone) const {
    range("twist", cone.twist);
    const std::size_t count = cone.polygon.size();
    if (count < 3) bad(fmt::format("has a reach cone of {} points, fewer than 3", count));
    if (!cone.center.allFinite() || std::abs(cone.center.norm() - 1) > 1e-6) bad("has a center not of unit length");
    double turned = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& u = cone.polygon[i];
      const Vec3& v = cone.polygon[(i + 1) % count];
      if (!u.allFinite() || u.norm() < kLimitRounding)
        bad(fmt::format("has a reach cone point {} without direction", i));
      if (u.dot(cone.center) <= kLimitRounding * u.norm()) {
        bad(fmt::format("has reach cone point {} 90 degrees or more from the center", i));
      }
      if (cone.center.dot(u.cross(v)) <= kLimitRounding * u.norm() * v.norm()) {
        bad(fmt::format("has a reach cone that is not star-shaped, counter-clockwise, at point {}", i));
      }
      const Vec3 a = u - u.dot(cone.center) * cone.center, b = v - v.dot(cone.center) * cone.center;
      turned += std::atan2(cone.center.dot(a.cross(b)), a.dot(b));
    }
    if (std::abs(turned - 2 * kPi) > 1e-6) bad("has a reach cone that winds round its center more than once");
  }

  void operator()(const PlaneJoint& plane) const { ordered("x", plane.x), ordered("z", plane.z); }

  [[noreturn]] void bad(const std::string& what) const { throw Error(ErrorCode::kBadData, what, where_); }

 private:
  void ordered(const char* name, const AngleRange& range) const {
    if (!std::isfinite(range.min) || !std::isfinite(range.max)) bad(fmt::format("has a range {} not finite", name));
    if (range.min > range.max) bad(fmt::format("has a range {} with its least above its most", name));
  }

  void range(const char* name, const AngleRange& range) const {
    ordered(name, range);
    if (range.max - range.min > 2 * kPi + kLimitRounding) bad(fmt::format("has a range {} wider than a turn", name));
    if (std::max(std::abs(range.min), std::abs(range.max)) > 2 * kPi + kLimitRounding) {
      bad(fmt::format("has a range {} beyond a turn", name));
    }
  }

  void ellipse(const char* name, const AngleRange& range) const {
    ordered(name, range);
    if (range.min > 0 || range.max < 0) bad(fmt::format("has a cone range {} that leaves 0 out", name));
    if (range.min < -kPi - kLimitRounding || range.max > kPi + kLimitRounding) {
      bad(fmt::format("has a cone range {} beyond half a turn", name));
    }
  }

  const std::string& where_;
};

bool isUnit(const Quat& q) {
  return q.coeffs().allFinite() && std::abs(q.norm() - 1) <= 1e-6;
}

}  // namespace

void checkLimit(const JointLimit& limit, const std::string& where) {
  const LimitChecker checker(where);
  if (!isUnit(limit.neutral)) checker.bad("has a neutral rotation not of unit length");
  if (!isUnit(limit.axes)) checker.bad("has axes that are not a rotation of unit length");
  if (!limit.restTranslation.allFinite()) checker.bad("has a rest translation that is not finite");
  if (!(limit.stiffness >= 0 && limit.stiffness <= 1)) checker.bad("has a stiffness outside 0 to 1");
  std::visit(checker, limit.motion);
}

}  // namespace limber
