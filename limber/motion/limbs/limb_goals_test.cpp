#include "limber/motion/limbs/limb_goals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

// How far above its position by the joint angles the left foot is kept, of a person who comes down to the ground at
// `speed`, metres a second, on arrival.
double liftedHeight(double speed) {
  const Skeleton person = practiceHumanoid(), odd = limber::testing::oddlyBuilt();
  const RetargetSetup setup(person, odd, matchSkeletons(person, odd), {});
  const RootPositioner root(setup);
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
    goals.adaptPose(source, seconds, to, target);
    goals.setFeet(source, target, seconds);
    up = leg.goal.position.y() - target.positions[leg.spec.end].y();
  }
  return up;
}

TEST(LimbGoals, AFootSlowsDownTheEarlierTheFasterItComes) {
  EXPECT_LT(liftedHeight(0.1), 0.01);
  EXPECT_GT(liftedHeight(2), liftedHeight(0.1) + 0.01);
  EXPECT_LT(liftedHeight(20), 0.05) << "however fast";
}

// The same animal but for a joint that nothing follows: its paws go into the ground as the source's do.
TEST(LimbGoals, LeaveWhatHasTheSameJoints) {
  const Skeleton animal = limber::testing::quadruped(0.5);
  Skeleton more = animal;
  limber::testing::addJoint(more, "saddle", "b0", Vec3(0, 0.1, 0.3));
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 20; ++f) {
    motion.poses.push_back(restPose(more));
    motion.poses.back().locals[0].translation.y() -= 0.3 - 0.01 * f;
  }
  const RetargetSetup setup(more, animal, matchSkeletons(more, animal), {}, &motion);
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, motion);
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    const std::vector<Affine> from = poseGlobals(more, motion.poses[f]), to = poseGlobals(animal, result.poses[f]);
    for (Index j = 0; j < animal.jointCount(); ++j) EXPECT_TRUE(from[j].isApprox(to[j], 1e-9));
  }
}

// Of a quadruped's paw on a root of its own, `lift` above its resting position in the source and at its position in the
// target: the distance of its goal from the hip, over the one that the paw's own path gives.
double bentBy(double lift, double sunk) {
  const Skeleton animal = limber::testing::onTheGround(limber::testing::quadruped(0.5),
                                                       {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"}),
                 bigger = limber::testing::scaled(animal, 2);
  const RetargetSetup setup(animal, bigger, matchSkeletons(animal, bigger), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  Leg& leg = goals.legs().front();
  Pose from = restPose(animal);
  from.locals[leg.spec.sourceEnd].translation.y() += lift;
  BodyFrame source, target;
  Pose to = restPose(bigger);
  setup.sourceKinematics.globals(from, source);
  setup.targetKinematics.globals(to, target);
  goals.adaptPose(source, 0, to, target);
  goals.setFeet(source, target, 0);
  leg.goal.position = target.positions[leg.spec.end] + Vec3(0, sunk, 0);
  const double own = (leg.goal.position - target.positions[leg.spec.upper]).norm();
  goals.bendAsSource(leg, target);
  return (leg.goal.position - target.positions[leg.spec.upper]).norm() / own;
}

TEST(LimbGoals, LegsOfLiftedFeetOnRootsOfTheirOwnBendAsTheSources) {
  EXPECT_NEAR(bentBy(0, 0.4), 1, 0.01) << "what is planted is foot-driven";
  EXPECT_NEAR(bentBy(0.5, 0), 0.4 / 0.9, 0.02) << "all of the source's bend";
  EXPECT_LT(bentBy(0, -1), 1.8 / 2.8) << "no further than a leg reaches";
}

// Joint angles of a dinosaur's legs, whose shins have hocks, leave a person's feet at other heights.
TEST(LimbGoals, FeetGoTheWayOfASourceWithHocks) {
  const Skeleton hocked = limber::testing::withHocks(practiceHumanoid()), person = practiceHumanoid();
  const RetargetSetup setup(hocked, person, matchSkeletons(hocked, person), {});
  ASSERT_TRUE(setup.person);
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  const Leg& leg = goals.legs().front();
  ASSERT_TRUE(leg.spec.drive);
  for (const double folds : {0.0, 40.0}) {
    Pose from = restPose(hocked), to = restPose(person);
    from.locals[hocked.find("leftLowerLeg").value()].rotation = limber::testing::turn(Vec3::UnitX(), folds);
    from.locals[hocked.find("leftHock").value()].rotation = limber::testing::turn(-Vec3::UnitX(), 2 * folds);
    BodyFrame source, target;
    setup.sourceKinematics.globals(from, source);
    setup.targetKinematics.globals(to, target);
    goals.adaptPose(source, 0, to, target);
    goals.setFeet(source, target, 0);
    const double lifted = setup.scale * (source.positions[leg.spec.sourceEnd].y() - leg.spec.sourceAnkleGround);
    EXPECT_NEAR(leg.goal.position.y() - leg.spec.ankleGround, lifted, 0.01);
    EXPECT_EQ(lifted > 0.1, folds > 0);
  }
}

TEST(LimbGoals, FeetOfTwoLeggedAnimalsGoTheSourcesWay) {
  for (const std::size_t legs : {4u, 2u}) {
    Skeleton one = limber::testing::quadruped(0.5), other = limber::testing::quadruped(0.35);
    for (Skeleton* skeleton : {&one, &other}) {
      if (legs == 2) skeleton->joints.resize(skeleton->find("b1LeftOne").value());
    }
    const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
    const RootPositioner root(setup);
    LimbGoals goals(setup, root);
    ASSERT_EQ(goals.legs().size(), legs);
    for (const Leg& leg : goals.legs()) EXPECT_EQ(leg.spec.drive.has_value(), legs == 2);
  }
}

// Of quadrupeds that were matched by their form; the other's paws stand further ahead at rest.
TEST(LimbGoals, WhoTurnsRoundStandsThereAsBefore) {
  const Skeleton animal = limber::testing::quadruped(0.5);
  Skeleton other = animal;
  for (Joint& joint : other.joints) {
    if (joint.name.ends_with("Three")) joint.rest.translation.z() += 0.2;
  }
  const RetargetSetup setup(animal, other, limber::testing::matchByForm(animal, other), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  Pose from = restPose(animal), to = restPose(other);
  const Quat round = limber::testing::turn(Vec3::UnitY(), 120);
  from.locals[0].rotation = to.locals[0].rotation = round;
  BodyFrame source, target;
  setup.sourceKinematics.globals(from, source);
  setup.targetKinematics.globals(to, target);
  goals.adaptPose(source, 0, to, target);
  goals.setFeet(source, target, 0);
  ASSERT_EQ(goals.legs().size(), 4u);
  const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
  for (const Leg& leg : goals.legs()) {
    const Vec3 restDirection = round * (rest[leg.spec.end] - rest[leg.spec.upper]),
               goal = leg.goal.position - target.positions[leg.spec.upper];
    EXPECT_LT((goal - restDirection).norm(), 0.01);
  }
}

// A paw that shoots up by half a leg is still pinned in the first frame after: the other legs keep their bend.
TEST(LimbGoals, AnAnimalsPelvisSinksSmoothly) {
  const Skeleton source = limber::testing::quadruped(0.5), target = limber::testing::quadruped(0.35);
  const RetargetSetup setup(source, target, matchSkeletons(source, target), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  constexpr double kFrame = 1.0 / 30;
  double before = 0, beforeAtOnce = 0, most = 0, maxAtOnce = 0;
  for (int f = 0; f < 20; ++f) {
    Pose from = restPose(source), to = restPose(target);
    for (Pose* pose : {&from, &to}) {
      const Skeleton& skeleton = pose == &from ? source : target;
      const double folds = std::clamp(20.0 * (f - 10), 0.0, 60.0);
      pose->locals[skeleton.find("b0LeftOne").value()].rotation = limber::testing::turn(Vec3::UnitX(), -folds);
      pose->locals[skeleton.find("b0LeftTwo").value()].rotation = limber::testing::turn(Vec3::UnitX(), 2 * folds);
    }
    BodyFrame sourceFrame, frame;
    setup.sourceKinematics.globals(from, sourceFrame);
    setup.targetKinematics.globals(to, frame);
    goals.adaptPose(sourceFrame, f == 0 ? 0 : kFrame, to, frame);
    goals.setFeet(sourceFrame, frame, f == 0 ? 0 : kFrame);
    const double up = goals.pelvisMove(frame).up, atOnce = goals.pelvis().moveFor(goals.legs(), frame).up;
    if (f > 0) {
      most = std::max(most, std::abs(up - before));
      maxAtOnce = std::max(maxAtOnce, std::abs(atOnce - beforeAtOnce));
    }
    before = up;
    beforeAtOnce = atOnce;
  }
  EXPECT_GT(maxAtOnce, 0.003);
  EXPECT_LT(most, 0.7 * maxAtOnce);
}

}  // namespace
}  // namespace limber
