#include "limber/skeleton/pose.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

Skeleton bentArm() {
  Skeleton skeleton;
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  skeleton.joints.push_back({"upper", std::nullopt, {Vec3(10, 2, -3), turn, Vec3(1, 2, 0.5)}, 0});
  skeleton.joints.push_back({"lower", 0, {Vec3(0.1, 1, 0), turn.conjugate(), Vec3::Ones()}, 0});
  skeleton.joints.push_back({"hand", 1, {Vec3(0, 0.7, 0), turn, Vec3::Constant(3)}, 0});
  return skeleton;
}

TEST(Pose, RestMovesNothingByABit) {
  const Skeleton skeleton = bentArm();
  for (const Affine& skin : skinTransforms(skeleton, restPose(skeleton))) {
    EXPECT_EQ(skin.matrix(), Mat4(Mat4::Identity()));
  }
}

TEST(Pose, TurningAJointMovesItsBranchAboutItAndNothingElse) {
  const Skeleton skeleton = bentArm();
  Pose pose = restPose(skeleton);
  pose.locals[1].rotation = pose.locals[1].rotation * Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  const std::vector<Affine> skin = skinTransforms(skeleton, pose);
  const std::vector<Affine> rest = restGlobals(skeleton);

  EXPECT_EQ(skin[0].matrix(), Mat4(Mat4::Identity()));
  const Vec3 elbow = rest[1].translation();
  EXPECT_LT((skin[1] * elbow - elbow).norm(), 1e-12);
  EXPECT_LT((skin[2].matrix() - skin[1].matrix()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((skin[2] * rest[2].translation() - rest[2].translation()).norm(), 0.1);
}

TEST(Pose, SmallestTurnIsNotTakenForRounding) {
  const Skeleton skeleton = bentArm();
  Pose pose = restPose(skeleton);
  pose.locals[0].translation.x() += 1e-9;
  EXPECT_NE(skinTransforms(skeleton, pose)[0].matrix(), Mat4(Mat4::Identity()));
}

TEST(Pose, FlatJointIsNamed) {
  Skeleton skeleton = bentArm();
  skeleton.joints[1].rest.scale = {1, 0, 1};
  EXPECT_THROW(inverseBindOf(skeleton), Error);
}

}  // namespace
}  // namespace limber
