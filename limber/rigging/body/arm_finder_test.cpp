#include "limber/rigging/body/arm_finder.h"

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

// The capsule person's left arm, in body space.
struct GivenArm {
  Vec3 shoulder, elbow, hand;
};
GivenArm givenArm() {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  return {person.frame.toBody(person.shape.shoulder), person.frame.toBody(person.shape.elbow),
          person.frame.toBody(person.shape.hand)};
}

}  // namespace

TEST(ArmFinder, SeesWhereTheArmLeavesTheTrunk) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const GivenArm arm = givenArm();
  // The shoulder is given too far out: the armpit stays where it is in the body.
  const Vec3 along = (arm.elbow - arm.shoulder).normalized();
  const ArmFinder right(person.body, person.frame, arm.shoulder, arm.elbow, arm.hand);
  const ArmFinder late(person.body, person.frame, arm.shoulder + 0.04 * along, arm.elbow, arm.hand);
  ASSERT_TRUE(right.armpit() && late.armpit());
  EXPECT_NEAR(*late.armpit(), *right.armpit() - 0.04, 0.015);
  EXPECT_LT(std::abs(*right.armpit()), 0.06);
  EXPECT_NEAR(right.radius(), 0.03, 0.006);
}

TEST(ArmFinder, KeepsToTheMiddleOfTheArm) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const GivenArm arm = givenArm();
  const Vec3 off(0, 0.01, 0.01);
  const ArmFinder finder(person.body, person.frame, arm.shoulder + off, arm.elbow + off, arm.hand + off);
  EXPECT_LT((finder.middle(finder.elbow()).value() - arm.elbow).norm(), 0.01);
  EXPECT_FALSE(finder.middle(3));
}

TEST(ArmFinder, FindsTheWrist) {
  // A forearm, a thin wrist and a thick hand, beside a trunk.
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0.05, 0}, {0, 0.95, 0}, 0.1);
  testing::addCapsule(mesh, {0.05, 0.7, 0}, {0.34, 0.7, 0}, 0.04);
  testing::addCapsule(mesh, {0.34, 0.7, 0}, {0.42, 0.7, 0}, 0.02);
  testing::addCapsule(mesh, {0.44, 0.7, 0}, {0.5, 0.7, 0}, 0.045);
  const BodyVolume body = measureBody(mesh);
  const AnatomicalFrame frame = frameAlong(mesh, body, Vec3::UnitY(), Vec3::UnitZ());
  const Vec3 shoulder = frame.toBody({0.1, 0.7, 0});
  const ArmFinder finder(body, frame, shoulder, frame.toBody({0.24, 0.7, 0}), frame.toBody({0.35, 0.7, 0}));
  const std::optional<double> wrist = finder.narrowest(0.7 * finder.hand(), 1.3 * finder.hand());
  ASSERT_TRUE(wrist);
  EXPECT_NEAR(shoulder.x() + *wrist, frame.toBody({0.388, 0.7, 0}).x(), 0.02);
  // An arm as thick everywhere shows none.
  EXPECT_FALSE(finder.narrowest(0.4 * finder.hand(), 0.6 * finder.hand()));
}

}  // namespace limber
