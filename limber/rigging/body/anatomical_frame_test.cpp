#include "limber/rigging/body/anatomical_frame.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "limber/rigging/body/testing/capsule_person.h"

namespace limber {

TEST(AnatomicalFrame, FindsThePlaneBetweenLeftAndRight) {
  testing::CapsulePerson person = testing::capsulePerson();
  testing::addCapsule(person.mesh, {-0.3, 0.7, 0}, {-0.45, 0.6, 0}, 0.02);  // something in one hand
  for (Vec3f& p : person.mesh.positions) p += Vec3f(0.2f, 0, 0);
  const BodyVolume body = measureBody(person.mesh);
  const AnatomicalFrame frame = frameAlong(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  EXPECT_TRUE(frame.symmetric());
  EXPECT_NEAR(frame.origin.x(), 0.2, 0.01);
  EXPECT_LT((frame.toBody({0.3, 0.5, 0}) - Vec3(0.1, 0.5, 0)).head<2>().norm(), 0.02);
  const Vec3 point(0.31, 0.4, 0.05);
  EXPECT_LT((frame.fromBody(frame.toBody(point)) - point).norm(), 1e-12);
  EXPECT_LT((frame.toBody(frame.mirrored(point)) - frame.toBody(point).cwiseProduct(Vec3(-1, 1, 1))).norm(), 1e-12);
}

TEST(AnatomicalFrame, IsRightHanded) {
  const testing::CapsulePerson person = testing::capsulePerson();
  const BodyVolume body = measureBody(person.mesh);
  const std::vector<AnatomicalFrame> frames = possibleFrames(person.mesh, body, std::nullopt, std::nullopt);
  EXPECT_EQ(frames.size(), 24u);
  for (const AnatomicalFrame& frame : frames) EXPECT_NEAR(frame.axes.determinant(), 1, 1e-12);
  // Feet tell front from back, and nothing tells left from right.
  const double across = frameAlong(person.mesh, body, Vec3::UnitY(), Vec3::UnitX()).asymmetry;
  EXPECT_GT(across, frameAlong(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ()).asymmetry + 0.05);
  EXPECT_EQ(possibleFrames(person.mesh, body, Vec3::UnitY(), std::nullopt).size(), 4u);
  EXPECT_EQ(possibleFrames(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ()).size(), 1u);
}

// A person, with something on the back, who looks along no axis or leans to one side.
TEST(AnatomicalFrame, FollowsBodiesThatAreTurned) {
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    SCOPED_TRACE(axis.transpose());
    const Mat3 turn = Eigen::AngleAxisd(0.5, axis).toRotationMatrix();
    testing::CapsulePerson person = testing::capsulePerson();
    testing::addCapsule(person.mesh, {0, 0.55, -0.2}, {0, 0.75, -0.2}, 0.1);
    for (Vec3f& p : person.mesh.positions) p = (turn * p.cast<double>()).cast<float>();
    const BodyVolume body = measureBody(person.mesh);
    const std::vector<AnatomicalFrame> frames = possibleFrames(person.mesh, body, std::nullopt, std::nullopt);
    ASSERT_TRUE(frames.front().symmetric());
    double best = -1;
    for (const AnatomicalFrame& frame : frames) {
      EXPECT_NEAR(frame.axes.determinant(), 1, 1e-12);
      best = std::max(best, std::min((frame.axes * turn).diagonal().minCoeff(), 1.0));
    }
    EXPECT_GT(best, 0.999) << "left, up and front go along";
    for (const AnatomicalFrame& frame : possibleFrames(person.mesh, body, Vec3::UnitY(), Vec3::UnitZ())) {
      EXPECT_TRUE(frame.axes.isIdentity()) << "as told";
    }
  }
}

}  // namespace limber
