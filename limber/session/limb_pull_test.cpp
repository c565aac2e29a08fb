#include "limber/session/limb_pull.h"

#include <array>

#include <gtest/gtest.h>

namespace limber {
namespace {

// root - trunk - two arms of three joints, hands last.
Skeleton body() {
  Skeleton skeleton;
  const auto add = [&](std::optional<Index> parent, const Vec3& at) {
    Joint joint;
    joint.name = "joint_" + std::to_string(skeleton.joints.size());
    joint.parent = parent;
    joint.rest.translation = at;
    skeleton.joints.push_back(joint);
    return skeleton.jointCount() - 1;
  };
  const Index trunk = add(add(std::nullopt, {0, 1, 0}), {0, 1, 0});
  for (const double side : {1.0, -1.0}) add(add(add(trunk, {0.5 * side, 0, 0}), {side, 0, 0.1}), {side, 0, 0});
  return skeleton;
}

constexpr Index kShoulder = 2, kElbow = 3, kHand = 4, kOtherHand = 7;

TEST(LimbBase, GoesUpToTheNextBranch) {
  const Skeleton skeleton = body();
  EXPECT_EQ(limbBase(skeleton, kHand), kShoulder);
  EXPECT_EQ(limbBase(skeleton, kElbow), kShoulder);
  EXPECT_EQ(limbBase(skeleton, kShoulder), Index{1});  // the trunk, though it branches: something has to turn
  EXPECT_FALSE(limbBase(skeleton, 1));                 // the root stays
  EXPECT_FALSE(limbBase(skeleton, 0));
}

TEST(LimbPull, BringsEveryJointThatHasALimb) {
  const Skeleton skeleton = body();
  std::array<HeldTarget, 3> targets = {{{kHand, {1.2, 2.9, 0.2}}, {0, {5, 5, 5}}, {kOtherHand, {-1.4, 1.2, -0.1}}}};
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
  const Skeleton skeleton = body();
  const std::array<HeldTarget, 1> targets = {{{0, {5, 5, 5}}}};
  LimbPull pull(skeleton, targets, nullptr);
  EXPECT_FALSE(pull.any());
  Pose pose = restPose(skeleton);
  pull.solve(pose, targets);
  EXPECT_EQ(pose.locals[0].translation, Vec3(0, 1, 0));
}

}  // namespace
}  // namespace limber
