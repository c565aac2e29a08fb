#include "limber/skeleton/humanoid_bones.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

TEST(HumanoidBones, TheTableIsATree) {
  for (const std::string_view bone : humanoidBones()) {
    int steps = 0;
    for (auto up = humanoidParent(bone); up; up = humanoidParent(*up)) ASSERT_LT(++steps, 20) << bone;
  }
  EXPECT_EQ(humanoidBones().size(), 55U);
  EXPECT_FALSE(humanoidParent("tail"));
}

TEST(HumanoidBones, JointsAreTakenByTheirWholeNames) {
  Skeleton skeleton;
  for (const char* name : {"root", "hips", "LeftFoot", "head"}) skeleton.joints.push_back({name, std::nullopt, {}});
  const std::vector<HumanoidJoint> joints = jointsCalledAsBones(skeleton);
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(joints[0].bone, "hips");
  EXPECT_EQ(joints[0].joint, 1u);
  EXPECT_EQ(joints[1].joint, 3u);
}

}  // namespace
}  // namespace limber
