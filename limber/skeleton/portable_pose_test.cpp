#include "limber/skeleton/portable_pose.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

Skeleton threeBones(double length = 1) {
  Skeleton skeleton;
  for (const char* name : {"shoulder", "elbow", "hand"}) {
    Joint joint;
    joint.name = name;
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    joint.rest.translation = Vec3(0, length, 0.125);
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

PortablePose bent() {
  PortablePose pose{"bent", threeBones(), restPose(threeBones())};
  pose.pose.locals[1].rotation = Quat(Eigen::AngleAxisd(0.7, Vec3::UnitX()));
  pose.pose.locals[0].translation = Vec3(1.0 / 3, 2, 3);
  return pose;
}

TEST(PortablePose, TheSameSkeletonGetsItBitForBitInWhateverOrder) {
  const std::optional<Pose> same = poseByNames(bent(), threeBones());
  ASSERT_TRUE(same);
  for (Index j = 0; j < 3; ++j) {
    EXPECT_EQ(same->locals[j].rotation.coeffs(), bent().pose.locals[j].rotation.coeffs());
    EXPECT_EQ(same->locals[j].translation, bent().pose.locals[j].translation);
  }
  Skeleton rounded = threeBones();
  for (Joint& joint : rounded.joints) joint.rest.translation = joint.rest.translation.cast<float>().cast<double>();
  EXPECT_TRUE(poseByNames(bent(), rounded));
}

TEST(PortablePose, AJointMoreOrLessChangesNothingElse) {
  Skeleton more = threeBones(), less = threeBones();
  Joint ring;
  ring.name = "ring";
  ring.parent = 2;
  ring.rest.translation = Vec3(0, 0.1, 0);
  more.joints.push_back(ring);
  less.joints.pop_back();
  const std::optional<Pose> on = poseByNames(bent(), more);
  ASSERT_TRUE(on);
  EXPECT_EQ(on->locals[3].translation, ring.rest.translation);
  EXPECT_EQ(on->locals[1].rotation.coeffs(), bent().pose.locals[1].rotation.coeffs());
  ASSERT_TRUE(poseByNames(bent(), less));
}

TEST(PortablePose, AnotherSkeletonIsNotTheSame) {
  EXPECT_FALSE(poseByNames(bent(), threeBones(1.01)));
  Skeleton others = threeBones();
  for (Joint& joint : others.joints) joint.name += "_";
  EXPECT_FALSE(poseByNames(bent(), others));
  Skeleton hungElsewhere = threeBones();
  hungElsewhere.joints[2].parent = 0;
  EXPECT_FALSE(poseByNames(bent(), hungElsewhere));
}

}  // namespace
}  // namespace limber
