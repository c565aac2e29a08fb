#include "limber/motion/limbs/body/trunk_tilt.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;
using limber::testing::turn;

// With names of its own and a trunk that is so many times as long.
Skeleton longTrunked(double times) {
  Skeleton animal = quadruped(0.4);
  for (Joint& joint : animal.joints) {
    if (joint.name == "b1") joint.rest.translation *= times;
    joint.name = "q" + joint.name;
  }
  return animal;
}

class TrunkTiltTest : public ::testing::Test {
 protected:
  // The source's hindquarters, and with them all of it, turn up by that, degrees.
  void rear(double degrees) {
    Pose from = restPose(source_);
    from.locals[0].rotation = turn(-Vec3::UnitX(), degrees);
    to_ = restPose(target_);
    to_.locals[0].rotation = from.locals[0].rotation;
    setup_.sourceKinematics.globals(from, sourceFrame_);
    setup_.targetKinematics.globals(to_, frame_);
    before_ = frame_;
    tilt_.follow(sourceFrame_, to_, frame_);
  }
  const Vec3& at(const char* name) const { return frame_.positions[target_.find(name).value()]; }
  double sourceRise() const {
    return (sourceFrame_.positions[source_.find("b1LeftOne").value()] -
            sourceFrame_.positions[source_.find("b0LeftOne").value()])
        .y();
  }
  double rise() const { return (at("qb1LeftOne") - at("qb0LeftOne")).y(); }

  const Skeleton source_ = quadruped(0.5), target_ = longTrunked(1.5);
  const RetargetSetup setup_{source_, target_, limber::testing::matchByForm(source_, target_), {}};
  const RootPositioner root_{setup_};
  const TrunkTilt tilt_{setup_, root_};
  Pose to_;
  BodyFrame sourceFrame_, frame_, before_;
};

TEST_F(TrunkTiltTest, ShouldersRiseAsTheSources) {
  ASSERT_TRUE(tilt_.tilts());
  for (const double degrees : {-30.0, 10.0, 45.0}) {
    rear(degrees);
    EXPECT_NEAR(rise(), setup_.scale * sourceRise(), 0.01) << degrees;
    EXPECT_NEAR(0.5 * (at("qb0LeftOne") + at("qb0RightOne") - before_.positions[target_.find("qb0LeftOne").value()] -
                       before_.positions[target_.find("qb0RightOne").value()])
                          .norm(),
                0, 1e-9)
        << "about the hips";
  }
}

TEST_F(TrunkTiltTest, WhatHangsOnItKeepsItsTurn) {
  rear(30);
  for (const char* name : {"qb0LeftOne", "qb1RightOne", "qb1RightThree", "qn0", "qn1", "qtail1", "qtail3"}) {
    const Index joint = target_.find(name).value();
    EXPECT_LT(frame_.rotations[joint].angularDistance(before_.rotations[joint]), 1e-6) << name;
  }
  const Index trunk = target_.find("qb1").value();
  EXPECT_GT(frame_.rotations[trunk].angularDistance(before_.rotations[trunk]), 0.1);
  BodyFrame again;
  setup_.targetKinematics.globals(to_, again);
  for (Index j = 0; j < target_.jointCount(); ++j) {
    EXPECT_LT((again.positions[j] - frame_.positions[j]).norm(), 1e-9) << "the pose is what the frame says";
  }
}

TEST_F(TrunkTiltTest, AtRestAndUprightNothingSnaps) {
  rear(0);
  EXPECT_LT(frame_.rotations[0].angularDistance(before_.rotations[0]), 1e-9);
  rear(60);
  Quat last = frame_.rotations[0];
  for (double degrees = 60; degrees < 120; degrees += 0.5) {
    rear(degrees);
    if (std::abs(degrees - 90) > 1) {
      EXPECT_LT(frame_.rotations[0].angularDistance(last), 0.05) << degrees;
    }
    last = frame_.rotations[0];
  }
}

TEST(TrunkTilt, LiftsShouldersAsItsTurnDoes) {
  for (const Vec3& trunk : {Vec3(0, 0, 1.3), Vec3(0.2, 0.7, 1), Vec3(-0.3, -0.6, 0.8)}) {
    const double rise = 1e-5;
    const Vec3 moved = TrunkTilt::turnFor(rise, trunk) * trunk - trunk;
    EXPECT_LT((moved / rise - TrunkTilt::liftOf(trunk)).norm(), 1e-4);
  }
  EXPECT_EQ(TrunkTilt::liftOf(Vec3::UnitY()), Vec3::UnitY());
}

TEST(TrunkTilt, LeavesPeopleAndThoseMatchedByNamesAlone) {
  const Skeleton person = practiceHumanoid(), animal = quadruped(0.5), other = quadruped(0.4);
  const RetargetSetup people(person, person, matchSkeletons(person, person), {});
  const RetargetSetup named(animal, other, matchSkeletons(animal, other), {});
  EXPECT_FALSE(TrunkTilt(people, RootPositioner(people)).tilts());
  EXPECT_FALSE(TrunkTilt(named, RootPositioner(named)).tilts());
}

}  // namespace
}  // namespace limber
