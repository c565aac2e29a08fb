#include "limber/document/live/vmc_stream.h"

#include <cmath>

#include <gmock/gmock.h>

#include "limber/core/text/numbers.h"
#include "limber/document/testing/osc_bytes.h"

namespace limber {
namespace {

using testing::vmcMessage;

const Quat kNoTurn = Quat::Identity();

Bytes bone(const std::string& name, const Vec3& position = Vec3::Zero(), const Quat& rotation = kNoTurn) {
  return vmcMessage("/VMC/Ext/Bone/Pos", name, position, rotation);
}

TEST(VmcStream, ItsSkeletonIsThereOnceItsBonesAre) {
  VmcStream stream;
  EXPECT_TRUE(stream.take(bone("LeftUpperLeg"), 0));
  EXPECT_EQ(stream.skeleton(1), nullptr);  // no hips
  stream.take(testing::oscBundle({bone("Hips"), bone("LeftHand"), bone("Tail")}), 1);
  EXPECT_EQ(stream.skeleton(1.2), nullptr);
  const Skeleton* skeleton = stream.skeleton(1.3);
  ASSERT_NE(skeleton, nullptr);
  EXPECT_EQ(stream.skeletonNumber(), 1u);
  ASSERT_EQ(skeleton->joints.size(), 3u);
  EXPECT_EQ(skeleton->joints[0].name, "Hips");
  EXPECT_EQ(skeleton->joints[2].name, "LeftHand");
  EXPECT_EQ(skeleton->joints[2].parent, Index{0});  // no bone between has come
  // No bone comes with a position, so they get those of a person in a T-pose on the ground.
  EXPECT_NEAR(restPositions(*skeleton)[2].x(), 0.74, 1e-9);
  stream.take(bone("Head"), 2);
  EXPECT_EQ(stream.skeleton(2.1)->joints.size(), 3u);
  EXPECT_EQ(stream.skeleton(2.3)->joints.size(), 4u);
  EXPECT_EQ(stream.skeletonNumber(), 2u);
  EXPECT_EQ(stream.taken(), 4u);
}

// Unity's x points to the right: a left hand lies at -x, and a turn that brings it up there is one about -z.
TEST(VmcStream, ComesOutRightHanded) {
  VmcStream stream;
  const Quat up(Eigen::AngleAxisd(-kPi / 2, Vec3::UnitZ()));
  stream.take(vmcMessage("/VMC/Ext/Root/Pos", "root", {0, 0, 2}, Quat(Eigen::AngleAxisd(kPi, Vec3::UnitY()))), 0);
  stream.take(bone("Hips", {0.1, 1, 0.3}), 0);
  stream.take(bone("LeftUpperArm", {-0.2, 0.4, 0}, up), 0);
  stream.take(bone("LeftLowerArm", {-0.3, 0, 0}), 0);
  stream.take(bone("LeftFoot", {-0.1, -0.8, 0}), 0);
  ASSERT_NE(stream.skeleton(1), nullptr);
  const Skeleton& skeleton = *stream.skeleton(1);
  const std::vector<Vec3> rest = restPositions(skeleton);
  const std::size_t lower = *skeleton.find("LeftLowerArm"), upper = *skeleton.find("LeftUpperArm");
  EXPECT_LT((rest[lower] - Vec3(0.5, 1.2, 0)).norm(), 1e-6);  // its foot is at height 0
  const std::vector<Vec3> now = posePositions(skeleton, stream.pose());
  EXPECT_LT((now[0] - Vec3(0.1, 1, 2 - 0.3)).norm(), 1e-6);  // turned about by the root
  EXPECT_LT((now[lower] - now[upper] - Vec3(0, 0.3, 0)).norm(), 1e-6);
}

TEST(VmcStream, LeavesOutWhatIsNoPose) {
  VmcStream stream;
  stream.take(bone("Hips"), 0);
  EXPECT_TRUE(stream.take(bone("Hips", {NAN, 0, 0}), 0));
  EXPECT_TRUE(stream.take(bone("Hips", {1e9, 0, 0}), 0));
  EXPECT_TRUE(stream.take(bone("Hips", {0, 5, 0}, Quat(0, 0, 0, 0)), 0));
  EXPECT_TRUE(stream.take(testing::oscMessage("/VMC/Ext/Bone/Pos", {std::string("Hips")}), 0));
  EXPECT_TRUE(stream.take(testing::oscMessage("/VMC/Ext/OK", {1.0f}), 0));
  EXPECT_FALSE(stream.take(Bytes(8, 'x'), 0));
  EXPECT_EQ(stream.taken(), 1u);
  ASSERT_NE(stream.skeleton(1), nullptr);
  EXPECT_EQ(stream.pose().locals[0].translation, Vec3(0, 0, 0));
}

}  // namespace
}  // namespace limber
