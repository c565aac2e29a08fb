#include "limber/session/drag/limb_pull.h"

#include <array>

#include <gtest/gtest.h>

#include "limber/session/testing/two_armed_body.h"

namespace limber {
namespace {

using testing::kElbow;
using testing::kHand;
using testing::kOtherHand;
using testing::kShoulder;
using testing::twoArmedBody;

TEST(LimbBase, GoesUpToTheNextBranch) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  EXPECT_EQ(limbBase(skeleton, kHand), kShoulder);
  EXPECT_EQ(limbBase(skeleton, kElbow), kShoulder);
  EXPECT_EQ(limbBase(skeleton, kShoulder), Index{1});  // the trunk, though it branches: something has to turn
  EXPECT_FALSE(limbBase(skeleton, 1));                 // the root stays
  EXPECT_FALSE(limbBase(skeleton, 0));
}

TEST(LimbPull, BringsEveryJointThatHasALimb) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  std::array<PinnedTarget, 3> targets = {{{kHand, {1.2, 2.9, 0.2}}, {0, {5, 5, 5}}, {kOtherHand, {-1.4, 1.2, -0.1}}}};
  LimbPull pull(skeleton, targets, nullptr);
  ASSERT_TRUE(pull.any());
  for (const double step : {0.0, 0.1}) {
    targets[0].position.y() -= step;
    Pose pose = restPose(skeleton);
    pull.solve(pose, targets);
    const std::vector<Affine> globals = poseGlobals(skeleton, pose);
    EXPECT_LT((globals[kHand].translation() - targets[0].position).norm(), 1e-3);
    EXPECT_LT((globals[kOtherHand].translation() - targets[2].position).norm(), 1e-3);
    EXPECT_EQ(globals[0].translation(), Vec3(0, 1, 0));
  }
}

TEST(LimbPull, WithoutALimbNothingMoves) {
  const Skeleton skeleton = twoArmedBody(BoneShape::kSphere);
  const std::array<PinnedTarget, 1> targets = {{{0, {5, 5, 5}}}};
  LimbPull pull(skeleton, targets, nullptr);
  EXPECT_FALSE(pull.any());
  Pose pose = restPose(skeleton);
  pull.solve(pose, targets);
  EXPECT_EQ(pose.locals[0].translation, Vec3(0, 1, 0));
}

}  // namespace
}  // namespace limber
