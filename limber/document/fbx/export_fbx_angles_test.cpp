#include "limber/document/fbx/export_fbx_angles.h"

#include <gtest/gtest.h>

#include "limber/core/random.h"
#include "limber/core/text/numbers.h"

namespace limber {
namespace {

constexpr double kClose = 1e-6;  // radians: a few roundings of 180 degrees to single precision

Quat turn(double x, double y, double z) {
  return Quat((Eigen::AngleAxisd(z * kDegree, Vec3::UnitZ()) * Eigen::AngleAxisd(y * kDegree, Vec3::UnitY()) *
               Eigen::AngleAxisd(x * kDegree, Vec3::UnitX()))
                  .toRotationMatrix());
}

TEST(EulerDegrees, KnownTurns) {
  EXPECT_TRUE(eulerDegrees(turn(30, 0, 0)).isApprox(Vec3(30, 0, 0), 1e-6));
  EXPECT_TRUE(eulerDegrees(turn(10, -20, 130)).isApprox(Vec3(10, -20, 130), 1e-6));
}

TEST(EulerDegrees, AnyRotationComesBackThroughMatricesAboutTheAxes) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.normal(), y = random.normal(), z = random.normal(), w = random.normal();
    const Quat rotation = Quat(w, x, y, z).normalized();
    const Vec3 degrees = eulerDegrees(rotation);
    EXPECT_LT(turn(degrees.x(), degrees.y(), degrees.z()).angularDistance(rotation), kClose);
    EXPECT_LT(eulerRotation(degrees).angularDistance(rotation), kClose);
  }
}

TEST(EulerDegreesNear, TheSameRotationAtThePole) {
  Random random(6);
  for (const double pole : {90.0, -90.0, 89.9999999, -89.999}) {
    for (int i = 0; i < 50; ++i) {
      const double x = random.uniform(-180, 180), z = random.uniform(-180, 180), before = random.uniform(-400, 400);
      const Quat rotation = turn(x, pole, z);
      const Vec3 near = eulerDegreesNear(rotation, Vec3(before, pole, before / 2));
      EXPECT_LT(turn(near.x(), near.y(), near.z()).angularDistance(rotation), 3 * kClose) << pole;
    }
  }
}

// Turning on and on about each axis, and through the pole: no angle jumps.
TEST(EulerDegreesNear, AnglesGoOnWhereTheyWere) {
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.6, 0, 0.8), Vec3(0.1, 0.7, 0.2)}) {
    Vec3 before = Vec3::Zero();
    double most = 0;
    for (double degrees = 0; degrees < 1000; ++degrees) {
      const Quat rotation(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
      const Vec3 near = eulerDegreesNear(rotation, before);
      EXPECT_LT(eulerRotation(near).angularDistance(rotation), 3 * kClose);
      most = std::max(most, (near - before).cwiseAbs().maxCoeff());
      before = near;
    }
    EXPECT_LT(most, 10) << axis.transpose();
  }
}

}  // namespace
}  // namespace limber
