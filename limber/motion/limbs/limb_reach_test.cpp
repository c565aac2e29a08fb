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
    leg_.goal = frame_.positions[leg_.end] + displacement;
    reach_.reach(leg_, &leg_.kneeAhead, frame_, pose_);
  }
  Vec3 knee() const {
    return frame_.positions[leg_.lower] - 0.5 * (frame_.positions[leg_.upper] + frame_.positions[leg_.end]);
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
  const Quat foot = frame_.rotations[leg_.end];
  reach(Vec3(0.05, 0.2, 0.1));
  EXPECT_LT((frame_.positions[leg_.end] - leg_.goal).norm(), 1e-9);
  EXPECT_LT(frame_.rotations[leg_.end].angularDistance(foot), 1e-9);
  EXPECT_TRUE(LimbReach::isThere(leg_, frame_));
  BodyFrame anew;
  setup_.targetKinematics.globals(pose_, anew);
  EXPECT_LT((anew.positions[leg_.end] - leg_.goal).norm(), 1e-9) << "the pose says what the frame says";
}

TEST_F(LimbReachTest, TurnsTheFootWhereAsked) {
  const Quat foot = frame_.rotations[leg_.end];
  leg_.turn = Eigen::AngleAxisd(0.3, Vec3::UnitY());
  EXPECT_FALSE(LimbReach::isThere(leg_, frame_));
  reach(Vec3(0, 0.1, 0));
  EXPECT_LT(frame_.rotations[leg_.end].angularDistance(leg_.turn * foot), 1e-9);
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
      EXPECT_EQ(leg.hock, animal.find("b1LeftHock"));
      if (!byHock) leg.hock.reset();
      leg.goal = frame.positions[leg.end] + Vec3(0, up, 0);
      const Vec3 thigh = frame.positions[leg.lower] - frame.positions[leg.upper];
      const Quat foot = frame.rotations[leg.end];
      reach.reach(leg, &leg.kneeAhead, frame, pose);
      EXPECT_EQ((frame.positions[leg.end] - leg.goal).norm() < 1e-9, up > -0.1);
      EXPECT_LT(frame.rotations[leg.end].angularDistance(foot), 1e-9);
      const Index hock = animal.find("b1LeftHock").value();
      const Vec3 above = frame.positions[leg.lower] - frame.positions[hock];
      EXPECT_GT(above.cross(frame.positions[leg.end] - frame.positions[hock]).x(), 0) << "it never bends over";
      return std::acos(thigh.normalized().dot((frame.positions[leg.lower] - frame.positions[leg.upper]).normalized()));
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
    EXPECT_FALSE(LimbGoals(alike, root).legs().front().ownBend);
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
    EXPECT_TRUE(leg.ownBend);
    Pose pose = restPose(animal);
    pose.locals[leg.lower].rotation = Eigen::AngleAxisd(-overstretched, Vec3::UnitX());
    BodyFrame frame;
    setup.targetKinematics.globals(pose, frame);
    const auto kneeAhead = [&] {
      const Vec3 line = (frame.positions[leg.end] - frame.positions[leg.upper]).normalized();
      const Vec3 knee = frame.positions[leg.lower] - frame.positions[leg.upper];
      return (knee - knee.dot(line) * line).z();
    };
    EXPECT_LT(kneeAhead(), 0);
    leg.goal = frame.positions[leg.end] + Vec3(0, 0.1, 0);
    reach.reach(leg, &leg.kneeAhead, frame, pose);
    EXPECT_LT((frame.positions[leg.end] - leg.goal).norm(), 1e-9);
    EXPECT_GT(kneeAhead(), 0.02);
  }
}

TEST_F(LimbReachTest, StraightKneesBendForward) {
  reach(Vec3(0, 0.1, 0));
  EXPECT_GT(knee().z(), 0.02);
}

}  // namespace
}  // namespace limber
