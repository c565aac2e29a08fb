#include "limber/retarget/limb_goals.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

// How far above its place by the joint angles the left foot is held, of someone who comes down to the ground at
// `speed`, metres a second, when it is there.
double heldUp(double speed) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::oddlyBuilt();
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPlacer root(setup);
  LimbGoals goals(setup, root);
  const Leg& leg = goals.legs().front();
  constexpr double kFrame = 1.0 / 60;
  double up = 0;
  for (int left = 10; left >= 0; --left) {
    const Vec3 height(0, left * kFrame * speed, 0);
    Pose from = restPose(person), to = restPose(odd);
    from.locals[0].translation += height;
    to.locals[0].translation += height;
    BodyFrame source, target;
    setup.sourceKinematics.globals(from, source);
    setup.targetKinematics.globals(to, target);
    const double seconds = left == 10 ? 0 : kFrame;
    goals.calm(source, seconds, to, target);
    goals.setFeet(source, target, seconds);
    up = leg.goal.y() - target.positions[leg.end].y();
  }
  return up;
}

TEST(LimbGoals, AFootSlowsDownTheEarlierTheFasterItComes) {
  EXPECT_LT(heldUp(0.1), 0.01);
  EXPECT_GT(heldUp(2), heldUp(0.1) + 0.01);
  EXPECT_LT(heldUp(20), 0.05) << "however fast";
}

// Of a quadruped's paw on a root of its own, `lift` above where it stands in the source and at its place in the target:
// how far its goal is from the hip, over the way by the paw's own way.
double bentBy(double lift, double sunk) {
  const Skeleton animal = limber::testing::onTheGround(limber::testing::quadruped(0.5),
                                                       {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"}),
                 bigger = limber::testing::scaled(animal, 2);
  const RetargetSetup setup(animal, bigger, matchSkeletons(animal, bigger), {});
  const RootPlacer root(setup);
  LimbGoals goals(setup, root);
  Leg& leg = goals.legs().front();
  Pose from = restPose(animal);
  from.locals[leg.sourceEnd].translation.y() += lift;
  BodyFrame source, target;
  Pose to = restPose(bigger);
  setup.sourceKinematics.globals(from, source);
  setup.targetKinematics.globals(to, target);
  goals.calm(source, 0, to, target);
  goals.setFeet(source, target, 0);
  leg.goal = target.positions[leg.end] + Vec3(0, sunk, 0);
  const double own = (leg.goal - target.positions[leg.upper]).norm();
  goals.bendAsSource(leg, target);
  return (leg.goal - target.positions[leg.upper]).norm() / own;
}

TEST(LimbGoals, LegsOfLiftedFeetOnRootsOfTheirOwnBendAsTheSources) {
  EXPECT_NEAR(bentBy(0, 0.4), 1, 0.01) << "what stands goes its own way";
  EXPECT_NEAR(bentBy(0.5, 0), 0.4 / 0.9, 0.02) << "all of the source's bend";
  EXPECT_LT(bentBy(0, -1), 1.8 / 2.8) << "no further than a leg reaches";
}

}  // namespace
}  // namespace limber
