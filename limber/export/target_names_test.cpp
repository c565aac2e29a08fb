#include "limber/export/target_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limber {
namespace {

using ::testing::ElementsAre;

TEST(NameStyle, SpellsWordsNumbersAndSides) {
  EXPECT_EQ(respelled("UpperArm_Twist01.L", NameStyle::kSnake), "upper_arm_twist_01_l");
  EXPECT_EQ(respelled("UpperArm_Twist01.L", NameStyle::kPascal), "LeftUpperArmTwist01");
  EXPECT_EQ(respelled("UpperArm_Twist01.L", NameStyle::kCamel), "leftUpperArmTwist01");
  EXPECT_EQ(respelled("UpperArm_Twist01.L", NameStyle::kDotted), "upper_arm_twist.01.L");
  EXPECT_EQ(respelled("UpperArm_Twist01.L", NameStyle::kMixamo), "mixamorig:LeftUpperArmTwist01");
  EXPECT_EQ(respelled("mixamorig:RightEye", NameStyle::kSnake), "eye_r");
  EXPECT_EQ(respelled("Bone.003", NameStyle::kSnake), "bone_003");  // there is nothing else to say
  EXPECT_EQ(respelled("feather2_1", NameStyle::kPascal), "Feather2_1");
}

// A chain of joints with these names, upwards.
Skeleton chain(const std::vector<std::string>& names) {
  Skeleton skeleton;
  for (const std::string& name : names) {
    Joint joint;
    joint.name = name;
    joint.rest.translation = Vec3(0, 0.2, 0);
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

TEST(TargetNames, CountsTheSpineHoweverManyJointsItHas) {
  const Skeleton skeleton = chain({"p", "a", "b", "c", "d", "n", "m", "h"});
  const std::vector<HumanoidJoint> bones = {{"hips", 0},       {"spine", 1}, {"chest", 3},
                                            {"upperChest", 4}, {"neck", 5},  {"head", 7}};
  const Anatomy none{{}, 0, 1, {}, std::vector<std::optional<std::size_t>>(8), 0};
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kUnreal, NameStyle::kSnake),
              ElementsAre("pelvis", "spine_01", "spine_02", "spine_03", "spine_04", "neck_01", "neck_02", "head"));
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kMixamo, NameStyle::kMixamo),
              ElementsAre("mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2",
                          "mixamorig:Spine3", "mixamorig:Neck", "mixamorig:Neck1", "mixamorig:Head"));
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kGodot, NameStyle::kPascal),
              ElementsAre("Hips", "Spine", "B", "Chest", "UpperChest", "Neck", "M", "Head"));
}

TEST(TargetNames, KeepsNamesApart) {
  const Skeleton skeleton = chain({"Hand.L", "hand_L", "lHand", "\xe6\x89\x8b"});
  const Anatomy none{{}, 0, 1, {}, std::vector<std::optional<std::size_t>>(4), 0};
  EXPECT_THAT(targetNames(skeleton, none, {}, BoneNames::kUnreal, NameStyle::kSnake),
              ElementsAre("hand_l", "hand_l_2", "hand_l_3", "\xe6\x89\x8b"));
}

}  // namespace
}  // namespace limber
