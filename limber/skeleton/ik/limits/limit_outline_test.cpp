#include "limber/skeleton/ik/limits/limit_outline.h"

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "random_values.h"

namespace limber {
namespace {

using testing::RandomValues;

std::vector<JointMotion> shownMotions() {
  ReachCone cone;
  cone.center = Vec3(0.1, 1, 0).normalized();
  cone.polygon = {Vec3(1, 0.6, 0), Vec3(0, 0.5, -1), Vec3(-1, 0.8, -0.2), Vec3(0.2, 1, 0.9)};
  return {Hinge{{-0.1, 2}},
          BallAndSocket{{-0.8, 1.4}, {-0.4, 1.7}, {-1, 1}},
          Condyloid{{-1.2, 1}, {-0.3, 0.5}},
          Saddle{{-0.5, 0.8}, {-0.3, 1}},
          SwingTwist{{-0.5, 1.2}, {-0.6, 0.6}, {-0.7, 0.6}},
          cone};
}

JointLimit turnedLimit(const JointMotion& motion, RandomValues& random) {
  JointLimit limit;
  limit.motion = motion;
  limit.neutral = random.rotation();
  limit.axes = random.rotation();
  return limit;
}

// How far the bone stays from a direction: the distance that nearestAllowed leaves to it, without twist.
double missBy(const JointLimit& limit, const Vec3& direction) {
  const Quat toParent = limit.neutral * limit.axes;
  const Quat swing = shortestRotation(Vec3::UnitY(), toParent.conjugate() * direction);
  const Quat local = limit.neutral * limit.axes * swing * limit.axes.conjugate();
  const Quat allowed = nearestAllowed(limit, local);
  const Vec3 bone = limit.axes * Vec3::UnitY();
  return (allowed * bone - direction).norm();
}

TEST(LimitOutline, ABoneReachesItsRimAndNotWhatIsBeyond) {
  RandomValues random(4);
  for (const JointMotion& motion : shownMotions()) {
    if (std::holds_alternative<Hinge>(motion) || std::holds_alternative<Saddle>(motion)) continue;  // no plain swings
    const JointLimit limit = turnedLimit(motion, random);
    const Vec3 bone = limit.axes * Vec3::UnitY();
    const LimitOutline outline = limitOutline(limit, 3 * bone, 40);
    ASSERT_GE(outline.rim.size(), 40U) << motion.index();
    EXPECT_TRUE(outline.closed);
    Vec3 middle = limit.neutral * bone;
    for (const Vec3& direction : outline.rim) {
      EXPECT_NEAR(direction.norm(), 1, 1e-12);
      EXPECT_LT(missBy(limit, direction), 1e-6) << motion.index();
      const Vec3 further = (shortestRotation(middle, direction) * direction - direction) * 0.05 + direction;
      EXPECT_GT(missBy(limit, further.normalized()), 1e-3) << motion.index();
      const Vec3 nearer = (0.95 * direction + 0.05 * middle).normalized();
      EXPECT_LT(missBy(limit, nearer), 1e-6) << motion.index();
    }
  }
}

TEST(LimitOutline, HingesAreFansAcrossTheirAxis) {
  RandomValues random(5);
  const JointLimit limit = turnedLimit(Hinge{{-0.5, 1.5}}, random);
  const Vec3 bone = limit.axes * Vec3::UnitY();
  const LimitOutline outline = limitOutline(limit, bone, 20);
  ASSERT_EQ(outline.rim.size(), 21U);
  EXPECT_FALSE(outline.closed);
  const Vec3 axis = limit.neutral * limit.axes * Vec3::UnitX();
  for (const Vec3& direction : outline.rim) EXPECT_NEAR(direction.dot(axis), 0, 1e-12);
  EXPECT_NEAR(std::acos(outline.rim.front().dot(limit.neutral * bone)), 0.5, 1e-9);
  EXPECT_NEAR(std::acos(outline.rim.back().dot(limit.neutral * bone)), 1.5, 1e-9);
}

TEST(LimitOutline, SaddlesTurnFirstAboutZThenAboutTheXCarriedAlong) {
  JointLimit limit;
  limit.motion = Saddle{{-0.5, 0.8}, {-0.3, 1}};
  for (const Vec3& direction : limitOutline(limit, Vec3::UnitY(), 16).rim) {
    // Every rim direction is an allowed rotation's, and one of its two angles is at its end.
    const double x = std::asin(direction.z()), z = std::atan2(-direction.x(), direction.y());
    const bool atEnd =
        std::abs(x + 0.5) < 1e-9 || std::abs(x - 0.8) < 1e-9 || std::abs(z + 0.3) < 1e-9 || std::abs(z - 1) < 1e-9;
    EXPECT_TRUE(atEnd) << x << ' ' << z;
    EXPECT_TRUE(x > -0.5 - 1e-9 && x < 0.8 + 1e-9 && z > -0.3 - 1e-9 && z < 1 + 1e-9) << x << ' ' << z;
  }
}

TEST(LimitOutline, WhatMovesNoBoneHasNone) {
  for (const JointMotion& motion :
       std::vector<JointMotion>{FreeJoint{}, FixedJoint{}, PlaneJoint{{-1, 1}, {-1, 1}}, Pivot{{-1, 1}}}) {
    JointLimit limit;
    limit.motion = motion;
    EXPECT_TRUE(limitOutline(limit, Vec3::UnitY(), 12).rim.empty()) << motion.index();
  }
}

}  // namespace
}  // namespace limber
