#include "limber/motion/limbs/body/body_lift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::quadruped;

// An animal whose legs begin far below its trunk.
Skeleton deepBodied() {
  Skeleton animal = quadruped(0.5);
  for (Joint& joint : animal.joints) {
    if (joint.name.ends_with("One")) joint.rest.translation.y() = -0.35;
    if (joint.name.ends_with("Two")) joint.rest.translation.y() += 0.3;
  }
  return animal;
}

class BodyLiftTest : public ::testing::Test {
 protected:
  // Of both with their trunks that far over the ground.
  double liftAt(double height) {
    Pose from = restPose(source_), to = restPose(target_);
    from.locals[0].translation.y() = to.locals[0].translation.y() = height;
    setup_.sourceKinematics.globals(from, sourceFrame_);
    setup_.targetKinematics.globals(to, frame_);
    return lift_(sourceFrame_, frame_);
  }

  const Skeleton source_ = quadruped(0.5), target_ = deepBodied();
  const RetargetSetup setup_{source_, target_, matchSkeletons(source_, target_), {}};
  const BodyLift lift_{setup_};
  BodyFrame sourceFrame_, frame_;
};

TEST_F(BodyLiftTest, WhoLiesDoesSoOnTheGround) {
  ASSERT_EQ(setup_.animalLegs.size(), 4u);
  const double lift = liftAt(0.15);
  const Index upper = target_.find("b0LeftOne").value(), sourceUpper = source_.find("b0LeftOne").value();
  const double lies = frame_.positions[upper].y() + lift - setup_.targetGround;
  const double asSource = setup_.scale * (sourceFrame_.positions[sourceUpper].y() - setup_.sourceGround);
  EXPECT_LT(frame_.positions[upper].y(), setup_.targetGround - 0.1);
  EXPECT_NEAR(lies, asSource, 0.08);
  EXPECT_GT(lies, 0);
}

TEST_F(BodyLiftTest, WhoStandsIsNotLifted) {
  EXPECT_LT(liftAt(1), 0.005);
}

TEST_F(BodyLiftTest, ComesWithoutAJump) {
  double before = liftAt(1);
  for (int step = 1; step <= 100; ++step) {
    const double lift = liftAt(1 - 0.01 * step);
    EXPECT_LT(std::abs(lift - before), 0.02) << step;
    before = lift;
  }
}

TEST(BodyLift, LeavesPeopleAlone) {
  const Skeleton person = practiceHumanoid(), other = limber::testing::oddlyBuilt();
  const RetargetSetup setup(person, other, matchSkeletons(person, other), {});
  Pose lying = restPose(other);
  lying.locals[0].translation.y() -= 2;
  BodyFrame source, target;
  setup.sourceKinematics.globals(restPose(person), source);
  setup.targetKinematics.globals(lying, target);
  EXPECT_EQ(BodyLift(setup)(source, target), 0);
}

}  // namespace
}  // namespace limber
