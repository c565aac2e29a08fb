#include "limber/skeleton/ik/limits/limits.h"

#include <random>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

double degrees(double d) {
  return d * kPi / 180;
}

AngleRange range(double low, double high) {
  return {degrees(low), degrees(high)};
}

ReachCone diamond() {
  ReachCone cone;
  cone.center = Vec3(0.1, 1, 0).normalized();
  cone.polygon = {Vec3(1, 0.6, 0), Vec3(0, 0.5, -1), Vec3(-1, 0.8, -0.2), Vec3(0.2, 1, 0.9)};
  cone.twist = range(-40, 60);
  return cone;
}

std::vector<JointMotion> everyMotion() {
  return {FreeJoint{},
          FixedJoint{},
          Hinge{range(-5, 140)},
          Pivot{range(-70, 60)},
          BallAndSocket{range(-50, 90), range(-20, 110), range(-60, 30)},
          Condyloid{range(-80, 70), range(-20, 35)},
          Saddle{range(-30, 50), range(-20, 60)},
          SwingTwist{range(-30, 75), range(-35, 35), range(-45, 40)},
          diamond(),
          PlaneJoint{{-0.1, 0.2}, {-0.05, 0.05}}};
}

JointLimit tilted(const JointMotion& motion, RandomValues& random) {
  JointLimit limit;
  limit.motion = motion;
  limit.neutral = random.rotation();
  limit.axes = random.rotation();
  return limit;
}

// Swing (x, z) and twist of a rotation, as the header defines them, from Eigen's own parts.
struct Parts {
  Vec3 bone;
  double swingX, swingZ, twist;
};

Parts partsOf(const JointLimit& limit, const Quat& local) {
  const Quat r = limit.axes.conjugate() * limit.neutral.conjugate() * local * limit.axes;
  Parts parts;
  parts.bone = r * Vec3(Vec3::UnitY());
  const Quat swing = shortestRotation(Vec3::UnitY(), parts.bone);
  const Eigen::AngleAxisd angleAxis(swing);
  const Eigen::AngleAxisd twist(Quat(swing.conjugate() * r));
  parts.swingX = angleAxis.angle() * angleAxis.axis().x();
  parts.swingZ = angleAxis.angle() * angleAxis.axis().z();
  parts.twist = wrapAngle(twist.angle() * twist.axis().y());
  return parts;
}

TEST(Limits, TheNearestAllowedIsAllowedAndAllowedStays) {
  RandomValues random(7);
  for (const JointMotion& motion : everyMotion()) {
    for (int i = 0; i < 500; ++i) {
      const JointLimit limit = tilted(motion, random);
      checkLimit(limit, "test");
      const Quat nearest = nearestAllowed(limit, random.rotation());
      EXPECT_NEAR(nearest.norm(), 1, 1e-12);
      EXPECT_LT(limitViolation(limit, nearest), 1e-7) << motion.index();
      const Quat allowed = allowedRotation(limit, random.unitCube());
      EXPECT_LT(limitViolation(limit, allowed), 1e-7) << motion.index();
    }
  }
}

// Hinge, pivot and saddle: no allowed rotation of a fine grid is nearer than the one found.
TEST(Limits, NothingAllowedIsNearer) {
  RandomValues random(7);
  for (const JointMotion& motion : {everyMotion()[2], everyMotion()[3], everyMotion()[6]}) {
    for (int i = 0; i < 60; ++i) {
      const JointLimit limit = tilted(motion, random);
      const Quat local = random.rotation();
      const double found = limitViolation(limit, local);
      double best = 10;
      for (int a = 0; a <= 100; ++a) {
        for (int b = 0; b <= 100; ++b) {
          best = std::min(best, angleBetween(local, allowedRotation(limit, Vec3(a / 100.0, b / 100.0, 0))));
        }
      }
      EXPECT_LE(found, best + 1e-9) << motion.index();
      EXPECT_GE(found, best - 0.03) << "the grid's step is 1.5 degrees";
    }
  }
}

TEST(Limits, EllipsesGiveTheNearestPoint) {
  RandomValues random(7);
  for (int i = 0; i < 300; ++i) {
    const AngleRange x{-random.uniform(0.05, 2), random.uniform(0.05, 2)};
    const AngleRange z{-random.uniform(0.05, 2), random.uniform(0.05, 2)};
    const Eigen::Vector2d point(random.uniform(-3, 3), random.uniform(-3, 3));
    const Eigen::Vector2d nearest = nearestInEllipses(x, z, point);
    const auto edgeAt = [&](int k) {
      const double c = std::cos(k * kPi / 2000), s = std::sin(k * kPi / 2000);
      return Eigen::Vector2d(c * (c < 0 ? -x.min : x.max), s * (s < 0 ? -z.min : z.max));
    };
    double best = 10;
    bool inside = true;
    for (int k = 0; k < 4000; ++k) {
      const Eigen::Vector2d edge = edgeAt(k), along = edgeAt(k + 1) - edge, offset = point - edge;
      best = std::min(best, offset.norm());
      inside = inside && along.x() * offset.y() - along.y() * offset.x() >= 0;
    }
    if (best < 1e-3) continue;  // on the edge, as far as the oracle can tell
    if (inside) {
      EXPECT_EQ(nearest, point);
    } else {
      EXPECT_LE((nearest - point).norm(), best + 1e-9);
      EXPECT_GE((nearest - point).norm(), best - 2e-3);
    }
  }
}

TEST(Limits, FlatEllipsesAreSegments) {
  EXPECT_EQ(nearestInEllipses({0, 0}, {-1, 2}, {0.5, 3}), Eigen::Vector2d(0, 2));
  EXPECT_EQ(nearestInEllipses({0, 0}, {-1, 2}, {-0.5, -0.5}), Eigen::Vector2d(0, -0.5));
  EXPECT_EQ(nearestInEllipses({0, 0}, {0, 0}, {1, 1}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(nearestInEllipses({-1, 0}, {-1, 2}, {0.5, 1}), Eigen::Vector2d(0, 1));
}

TEST(Limits, ConesAndBoxesBoundWhatTheySay) {
  RandomValues random(7);
  for (int i = 0; i < 2000; ++i) {
    const BallAndSocket ball = std::get<BallAndSocket>(everyMotion()[4]);
    const JointLimit cone = tilted(ball, random);
    const Parts c = partsOf(cone, nearestAllowed(cone, random.rotation()));
    const double x = c.swingX / (c.swingX < 0 ? -ball.x.min : ball.x.max);
    const double z = c.swingZ / (c.swingZ < 0 ? -ball.z.min : ball.z.max);
    EXPECT_LE(x * x + z * z, 1 + 1e-6);
    EXPECT_GE(c.twist, ball.twist.min - 1e-7);
    EXPECT_LE(c.twist, ball.twist.max + 1e-7);

    const SwingTwist box = std::get<SwingTwist>(everyMotion()[7]);
    const JointLimit boxed = tilted(box, random);
    const Parts b = partsOf(boxed, nearestAllowed(boxed, random.rotation()));
    EXPECT_GE(b.swingX, box.x.min - 1e-7);
    EXPECT_LE(b.swingX, box.x.max + 1e-7);
    EXPECT_LE(std::abs(b.swingZ), box.z.max + 1e-7);
    EXPECT_LE(b.twist, box.twist.max + 1e-7);
  }
}

TEST(Limits, ReachConesGiveTheNearestDirection) {
  RandomValues random(7);
  const ReachCone cone = diamond();
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 direction = random.rotation() * Vec3(Vec3::UnitY());
    const Vec3 nearest = nearestInReachCone(cone, direction);
    EXPECT_NEAR(nearest.norm(), 1, 1e-12);
    double best = 10;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 a = cone.polygon[k].normalized(), b = cone.polygon[(k + 1) % 4].normalized();
      for (int s = 0; s <= 400; ++s) {
        const Vec3 edge = ((1 - s / 400.0) * a + s / 400.0 * b).normalized();
        best = std::min(best, std::acos(std::clamp(edge.dot(direction), -1.0, 1.0)));
      }
    }
    if (nearest == direction) {
      ++inside;
      EXPECT_GT(direction.dot(cone.center), 0);
    } else {
      const double found = std::acos(std::clamp(nearest.dot(direction), -1.0, 1.0));
      EXPECT_LE(found, best + 1e-7);
      EXPECT_GE(found, best - 3e-3);
    }
  }
  EXPECT_GT(inside, 20);
}

// Small changes of a rotation that is not far outside give small changes of the nearest one.
TEST(Limits, ProjectionIsContinuous) {
  RandomValues random(7);
  for (const JointMotion& motion : everyMotion()) {
    for (int path = 0; path < 40; ++path) {
      const JointLimit limit = tilted(motion, random);
      const Quat start = allowedRotation(limit, random.unitCube());
      const Quat end = start * fromRotationVector(random.unitCube() - Vec3::Constant(0.5));
      Quat before = nearestAllowed(limit, start);
      for (int i = 1; i <= 500; ++i) {
        const Quat now = nearestAllowed(limit, start.slerp(i / 500.0, end));
        EXPECT_LT(angleBetween(before, now), 0.02) << motion.index() << " at step " << i;
        before = now;
      }
    }
  }
}

// Turning a little about one of the axes keeps an allowed rotation on the limit's surface, to second order.
TEST(Limits, AxesAreTangents) {
  RandomValues random(7);
  const int expected[] = {3, 0, 1, 1, 3, 2, 2, 3, 3, 0};
  for (const JointMotion& motion : everyMotion()) {
    for (int i = 0; i < 100; ++i) {
      const JointLimit limit = tilted(motion, random);
      // Well inside the ranges, so that no edge is met.
      const Quat local = allowedRotation(limit, Vec3(0.3, 0.2, 0.4) + 0.2 * random.unitCube());
      const TurnAxes axes = turnAxes(limit, local);
      ASSERT_EQ(axes.count, expected[motion.index()]);
      for (int k = 0; k < axes.count; ++k) {
        const Vec3& axis = axes.axes[static_cast<std::size_t>(k)];
        EXPECT_NEAR(axis.norm(), 1, 1e-12);
        constexpr double kTurn = 1e-4;
        EXPECT_LT(limitViolation(limit, local * fromRotationVector(kTurn * axis)), kTurn * kTurn) << motion.index();
      }
    }
  }
}

TEST(Limits, APlaneJointSlidesInItsPlane) {
  JointLimit limit;
  limit.motion = PlaneJoint{{-1, 2}, {0, 0.5}};
  limit.restTranslation = Vec3(10, 20, 30);
  EXPECT_EQ(nearestAllowedTranslation(limit, Vec3(15, 25, 29)), Vec3(12, 20, 30));
  EXPECT_EQ(nearestAllowedTranslation(limit, Vec3(10.5, 20, 30.25)), Vec3(10.5, 20, 30.25));
  limit.axes = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));  // the limit's X along the parent's Y
  EXPECT_LT((nearestAllowedTranslation(limit, Vec3(15, 25, 29)) - Vec3(10, 22, 30)).norm(), 1e-12);
  limit.motion = FreeJoint{};
  EXPECT_EQ(nearestAllowedTranslation(limit, Vec3(15, 25, 29)), Vec3(15, 25, 29));
}

TEST(Limits, NonsenseIsRefusedByName) {
  ReachCone twisted = diamond();
  std::swap(twisted.polygon[1], twisted.polygon[2]);
  ReachCone few = diamond();
  few.polygon.resize(2);
  for (const JointMotion& motion : std::vector<JointMotion>{
           Hinge{range(10, -10)}, Pivot{range(-200, 200)}, BallAndSocket{range(10, 20), range(-10, 10), range(0, 0)},
           Condyloid{range(-190, 10), range(0, 0)}, SwingTwist{range(-170, 10), range(-170, 10), range(0, 0)},
           Saddle{{0, NAN}, {0, 0}}, PlaneJoint{{1, 0}, {0, 0}}, twisted, few}) {
    JointLimit limit;
    limit.motion = motion;
    try {
      checkLimit(limit, "knee");
      ADD_FAILURE() << "accepted motion " << motion.index();
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "knee");
      EXPECT_EQ(error.code(), ErrorCode::kBadData);
    }
  }
  JointLimit limit;
  limit.stiffness = 1.5;
  EXPECT_THROW(checkLimit(limit, "knee"), Error);
  limit.stiffness = 0;
  limit.axes.coeffs() *= 2;
  EXPECT_THROW(checkLimit(limit, "knee"), Error);
}

}  // namespace
}  // namespace limber
