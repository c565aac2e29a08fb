#include "limber/skeleton/ik/limits/limit_outline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/rotation.h"

namespace limber {

namespace {

constexpr double kStill = 1e-9;  // a rim narrower than this is a point

double between(double a, double b, double fraction) {
  return a + fraction * (b - a);
}

// Directions of the bone in the limit's axes.
struct RimMaker {
  Vec3 bone;  // in the limit's axes
  Index steps;
  LimitOutline& outline;

  void add(const Quat& rotation) const { outline.rim.push_back(rotation * bone); }
  void fan(const AngleRange& range, const Vec3& axis) const {
    for (Index i = 0; i <= steps; ++i) add(fromRotationVector(between(range.min, range.max, double(i) / steps) * axis));
  }
  // Round a box of two angles.
  template <class Turn>
  void box(const AngleRange& x, const AngleRange& z, const Turn& turn) const {
    outline.closed = true;
    const double corners[5][2] = {{x.min, z.min}, {x.max, z.min}, {x.max, z.max}, {x.min, z.max}, {x.min, z.min}};
    const Index side = (steps + 3) / 4;
    for (int c = 0; c < 4; ++c) {
      for (Index i = 0; i < side; ++i) {
        const double fraction = double(i) / side;
        add(turn(between(corners[c][0], corners[c + 1][0], fraction),
                 between(corners[c][1], corners[c + 1][1], fraction)));
      }
    }
  }
  void ellipse(const AngleRange& x, const AngleRange& z) const {
    outline.closed = true;
    for (Index i = 0; i < steps; ++i) {
      const double angle = 2 * kPi * i / steps, c = std::cos(angle), s = std::sin(angle);
      add(fromRotationVector(Vec3(c * (c < 0 ? -x.min : x.max), 0, s * (s < 0 ? -z.min : z.max))));
    }
  }

  void operator()(const FreeJoint&) const {}
  void operator()(const FixedJoint&) const {}
  void operator()(const PlaneJoint&) const {}
  void operator()(const Hinge& limit) const { fan(limit.x, Vec3::UnitX()); }
  void operator()(const Pivot& limit) const { fan(limit.y, Vec3::UnitY()); }
  void operator()(const BallAndSocket& limit) const { ellipse(limit.x, limit.z); }
  void operator()(const Condyloid& limit) const { ellipse(limit.x, limit.z); }
  void operator()(const Saddle& limit) const {
    box(limit.x, limit.z, [](double x, double z) {
      return fromRotationVector(z * Vec3::UnitZ()) * fromRotationVector(x * Vec3::UnitX());
    });
  }
  void operator()(const SwingTwist& limit) const {
    box(limit.x, limit.z, [](double x, double z) { return fromRotationVector(Vec3(x, 0, z)); });
  }
  // The polygon itself, its sides great circles.
  void operator()(const ReachCone& limit) const {
    outline.closed = true;
    const std::size_t corners = limit.polygon.size();
    const Index side = static_cast<Index>((steps + corners - 1) / corners);
    for (std::size_t c = 0; c < corners; ++c) {
      const Vec3 from = limit.polygon[c].normalized(), to = limit.polygon[(c + 1) % corners].normalized();
      const Vec3 displacement = toRotationVector(shortestRotation(from, to));
      for (Index i = 0; i < side; ++i)
        outline.rim.push_back(fromRotationVector(double(i) / side * displacement) * from);
    }
  }
};

}  // namespace

LimitOutline limitOutline(const JointLimit& limit, const Vec3& bone, Index steps) {
  LimitOutline outline;
  std::visit(RimMaker{limit.axes.conjugate() * bone.normalized(), std::max<Index>(1, steps), outline}, limit.motion);
  const Quat toParent = limit.neutral * limit.axes;
  bool still = true;
  for (Vec3& direction : outline.rim) {
    direction = toParent * direction;
    still &= (direction - outline.rim.front()).norm() < kStill;
  }
  return still ? LimitOutline{} : outline;
}

}  // namespace limber
