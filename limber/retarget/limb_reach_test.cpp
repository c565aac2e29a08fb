#include "limber/retarget/limb_reach.h"

#include <gtest/gtest.h>

#include "limber/retarget/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::oddlyBuilt;

// A left leg of someone who stands.
class LimbReachTest : public ::testing::Test {
 protected:
  LimbReachTest() {
    setup_.targetKinematics.globals(pose_, frame_);
    leg_ = goals_.legs().front();
  }
  void reach(const Vec3& way) {
    leg_.goal = frame_.positions[leg_.end] + way;
    reach_.reach(leg_, &leg_.kneeAhead, frame_, pose_);
  }
  Vec3 knee() const {
    return frame_.positions[leg_.lower] - 0.5 * (frame_.positions[leg_.upper] + frame_.positions[leg_.end]);
  }

  const Skeleton source_ = practiceHumanoid(), target_ = oddlyBuilt();
  const RetargetSetup setup_{source_, target_, matchSkeletons(source_, target_), {}};
  const RootPlacer root_{setup_};
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

TEST_F(LimbReachTest, StraightKneesBendForward) {
  reach(Vec3(0, 0.1, 0));
  EXPECT_GT(knee().z(), 0.02);
}

}  // namespace
}  // namespace limber
