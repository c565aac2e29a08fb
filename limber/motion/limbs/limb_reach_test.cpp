#include "limber/motion/limbs/limb_reach.h"

#include <gtest/gtest.h>

#include <cmath>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;
using limber::testing::quadrupedWithHocks;

// A left leg of a person at rest.
class LimbReachTest : public ::testing::Test {
 protected:
  LimbReachTest() {
    setup_.targetKinematics.globals(pose_, frame_);
    leg_ = goals_.legs().front();
  }
  void reach(const Vec3& displacement) {
    leg_.goal.position = frame_.positions[leg_.spec.end] + displacement;
    reach_.reach(leg_.spec, leg_.goal, frame_, pose_);
  }
  Vec3 knee() const {
    return frame_.positions[leg_.spec.lower] -
           0.5 * (frame_.positions[leg_.spec.upper] + frame_.positions[leg_.spec.end]);
  }

  const Skeleton source_ = practiceHumanoid(), target_ = oddlyBuilt();
  const RetargetSetup setup_{source_, target_, matchSkeletons(source_, target_), {}};
  const RootPositioner root_{setup_};
  LimbGoals goals_{setup_, root_};
  const LimbReach reach_{setup_, root_};
  Pose pose_ = restPose(target_);
  BodyFrame frame_;
  Leg leg_;
};

TEST_F(LimbReachTest, ReachesAndKeepsTheFoot) {
  const Quat foot = frame_.rotations[leg_.spec.end];
  reach(Vec3(0.05, 0.2, 0.1));
  EXPECT_LT((frame_.positions[leg_.spec.end] - leg_.goal.position).norm(), 1e-9);
  EXPECT_LT(frame_.rotations[leg_.spec.end].angularDistance(foot), 1e-9);
  EXPECT_TRUE(LimbReach::isThere(leg_.spec, leg_.goal, frame_));
  BodyFrame anew;
  setup_.targetKinematics.globals(pose_, anew);
  EXPECT_LT((anew.positions[leg_.spec.end] - leg_.goal.position).norm(), 1e-9) << "the pose says what the frame says";
}

TEST_F(LimbReachTest, TurnsTheFootWhereAsked) {
  const Quat foot = frame_.rotations[leg_.spec.end];
  leg_.goal.turn = Eigen::AngleAxisd(0.3, Vec3::UnitY());
  EXPECT_FALSE(LimbReach::isThere(leg_.spec, leg_.goal, frame_));
  reach(Vec3(0, 0.1, 0));
  EXPECT_LT(frame_.rotations[leg_.spec.end].angularDistance(leg_.goal.turn * foot), 1e-9);
}

TEST(LimbReachOfAnimals, HocksBendAsWell) {
  const Skeleton animal = quadrupedWithHocks();
  Skeleton source = animal;
  source.joints[0].rest.translation.y() = 1.2;
  for (Joint& joint : source.joints) {
    if (joint.name.ends_with("Two")) joint.rest.translation.y() -= 0.2;
  }
  const RetargetSetup setup(source, animal, matchSkeletons(source, animal), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  ASSERT_EQ(goals.legs().size(), 4u);
  const LimbReach reach(setup, root);
  for (const double up : {0.05, -0.005, -0.5}) {
    SCOPED_TRACE(up);
    const auto thighTurns = [&](bool byHock) {
      Pose pose = restPose(animal);
      BodyFrame frame;
      setup.targetKinematics.globals(pose, frame);
      Leg leg = goals.legs().front();
      EXPECT_EQ(leg.spec.hock, animal.find("b1LeftHock"));
      if (!byHock) leg.spec.hock.reset();
      leg.goal.position = frame.positions[leg.spec.end] + Vec3(0, up, 0);
      const Vec3 thigh = frame.positions[leg.spec.lower] - frame.positions[leg.spec.upper];
      const Quat foot = frame.rotations[leg.spec.end];
      reach.reach(leg.spec, leg.goal, frame, pose);
      EXPECT_EQ((frame.positions[leg.spec.end] - leg.goal.position).norm() < 1e-9, up > -0.1);
      EXPECT_LT(frame.rotations[leg.spec.end].angularDistance(foot), 1e-9);
      const Index hock = animal.find("b1LeftHock").value();
      const Vec3 above = frame.positions[leg.spec.lower] - frame.positions[hock];
      EXPECT_GT(above.cross(frame.positions[leg.spec.end] - frame.positions[hock]).x(), 0) << "it never bends over";
      return std::acos(
          thigh.normalized().dot((frame.positions[leg.spec.lower] - frame.positions[leg.spec.upper]).normalized()));
    };
    const double alone = thighTurns(false), shared = thighTurns(true);
    if (up > -0.1) {
      EXPECT_LT(shared, 0.75 * alone);
    }
  }
}

// A horse's carpus has a dog's elbow's name and bends to the other side.
TEST(LimbReachOfAnimals, LegsBendAsAtRestWhereTheSourcesBendElsewhere) {
  const Skeleton animal = quadrupedWithHocks();
  Skeleton source = animal;
  source.joints[0].rest.translation.y() = 1.2;
  {
    const RetargetSetup alike(source, animal, matchSkeletons(source, animal), {});
    const RootPositioner root(alike);
    EXPECT_FALSE(LimbGoals(alike, root).legs().front().spec.ownBend);
  }
  for (Joint& joint : source.joints) {
    if (joint.name.ends_with("Two") || joint.name.ends_with("Hock")) joint.rest.translation.z() *= -1;
    if (joint.name.ends_with("Two"))
      joint.rest.translation.y() *= 1.1;  // with equal bones it would be a twin that rests so
  }
  const RetargetSetup setup(source, animal, matchSkeletons(source, animal), {});
  const RootPositioner root(setup);
  LimbGoals goals(setup, root);
  const LimbReach reach(setup, root);
  for (const double overstretched : {0.3, 0.6, 1.2}) {
    SCOPED_TRACE(overstretched);
    Leg leg = goals.legs().front();
    EXPECT_TRUE(leg.spec.ownBend);
    Pose pose = restPose(animal);
    pose.locals[leg.spec.lower].rotation = Eigen::AngleAxisd(-overstretched, Vec3::UnitX());
    BodyFrame frame;
    setup.targetKinematics.globals(pose, frame);
    const auto kneeAhead = [&] {
      const Vec3 line = (frame.positions[leg.spec.end] - frame.positions[leg.spec.upper]).normalized();
      const Vec3 knee = frame.positions[leg.spec.lower] - frame.positions[leg.spec.upper];
      return (knee - knee.dot(line) * line).z();
    };
    EXPECT_LT(kneeAhead(), 0);
    leg.goal.position = frame.positions[leg.spec.end] + Vec3(0, 0.1, 0);
    reach.reach(leg.spec, leg.goal, frame, pose);
    EXPECT_LT((frame.positions[leg.spec.end] - leg.goal.position).norm(), 1e-9);
    EXPECT_GT(kneeAhead(), 0.02);
  }
}

TEST_F(LimbReachTest, StraightKneesBendForward) {
  reach(Vec3(0, 0.1, 0));
  EXPECT_GT(knee().z(), 0.02);
}

}  // namespace
}  // namespace limber
