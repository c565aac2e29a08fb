#include "limber/actions/export/target_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/export/engine_target.h"
#include "limber/actions/export/testing/target_people.h"
#include "limber/character/anatomy/names/humanoid_joints.h"

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

// Of a skeleton with so many joints, none of them in a part.
Anatomy unread(std::size_t joints) {
  Anatomy anatomy;
  anatomy.size = 1;
  anatomy.partOf.resize(joints);
  return anatomy;
}

TEST(TargetNames, CountsTheSpineHoweverManyJointsItHas) {
  const Skeleton skeleton = chain({"p", "a", "b", "c", "d", "n", "m", "h"});
  const std::vector<HumanoidJoint> bones = {{"hips", 0},       {"spine", 1}, {"chest", 3},
                                            {"upperChest", 4}, {"neck", 5},  {"head", 7}};
  const Anatomy none = unread(8);
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kUnreal, NameStyle::kSnake).joints,
              ElementsAre("pelvis", "spine_01", "spine_02", "spine_03", "spine_04", "neck_01", "neck_02", "head"));
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kMixamo, NameStyle::kMixamo).joints,
              ElementsAre("mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2",
                          "mixamorig:Spine3", "mixamorig:Neck", "mixamorig:Neck1", "mixamorig:Head"));
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kGodot, NameStyle::kPascal).joints,
              ElementsAre("Hips", "Spine", "B", "Chest", "UpperChest", "Neck", "M", "Head"));
}

TEST(NameStyle, KeepsTheWordsOfTheName) {
  EXPECT_EQ(respelled("center_of_mass", NameStyle::kSnake), "center_of_mass");
  EXPECT_EQ(respelled("center_of_mass", NameStyle::kMixamo), "mixamorig:CenterOfMass");
  EXPECT_EQ(respelled("eye_center_L", NameStyle::kPascal), "LeftEyeCenter");
  EXPECT_EQ(respelled("Epicenter", NameStyle::kSnake), "epicenter");
  EXPECT_EQ(respelled("mixamorig:HeadTop_End", NameStyle::kMixamo), "mixamorig:HeadTop_End");
  EXPECT_EQ(respelled("toe_end_l", NameStyle::kMixamo), "mixamorig:LeftToe_End");
  EXPECT_EQ(respelled("toe_end_l", NameStyle::kPascal), "LeftToeEnd");
}

TargetNames namesFor(const Skeleton& skeleton, const std::string& target) {
  const EngineTarget& found = findTarget(target);
  return targetNames(skeleton, readAnatomy(skeleton), humanoidJoints(skeleton), found.boneNames, found.style);
}

Skeleton renamed(Skeleton skeleton, const std::string& target) {
  const TargetNames names = namesFor(skeleton, target);
  for (Index j = 0; j < skeleton.jointCount(); ++j) skeleton.joints[j].name = names.joints[j];
  return skeleton;
}

std::vector<std::string> namesOf(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints) names.push_back(joint.name);
  return names;
}

TEST(TargetNames, ASkeletonWithATargetsNamesKeepsThemAll) {
  for (const testing::TargetWords& words : testing::targetWords()) {
    const Skeleton skeleton = testing::TargetPerson(words).skeleton;
    EXPECT_TRUE(namesFor(skeleton, words.target).isOwn) << words.target;
    EXPECT_EQ(namesOf(renamed(skeleton, words.target)), namesOf(skeleton)) << words.target;
  }
}

// The skeleton under the names of the other target, and back.
void expectNamesToComeBack(const testing::TargetWords& words, const Skeleton& skeleton) {
  const testing::TargetPerson person(words);
  for (const testing::TargetWords& other : testing::targetWords()) {
    const Skeleton back = renamed(renamed(skeleton, other.target), words.target);
    for (const Index joint : person.body) {
      EXPECT_EQ(back.joints[joint].name, skeleton.joints[joint].name) << words.target << ' ' << other.target;
    }
  }
}

TEST(TargetNames, ComeBackFromTheNamesOfAnotherTarget) {
  for (const testing::TargetWords& words : testing::targetWords()) {
    expectNamesToComeBack(words, testing::TargetPerson(words).declared());
  }
}

// As far as the body is read by its form and its words alone: twist joints beside the fingers, two joints of a neck are
// not always told from others.
TEST(TargetNames, ComeBackWhereTheBodyIsReadToo) {
  for (const testing::TargetWords& words : testing::targetWords()) {
    expectNamesToComeBack(words, testing::TargetPerson(words).skeleton);
  }
}

// A wrong reading does not displace a name: neck_02 is no head where a head is called so.
TEST(TargetNames, OwnNamesCountMoreThanAReadingThatDiffers) {
  const testing::TargetPerson person(testing::unrealWords("unreal"));
  std::vector<HumanoidJoint> bones = humanoidJoints(person.skeleton);
  for (HumanoidJoint& bone : bones) {
    if (bone.bone == "head") bone.joint = *person.skeleton.find("neck_02");
    if (bone.bone == "leftLittleProximal") bone.joint = *person.skeleton.find("middle_01_l");
  }
  const Anatomy none = unread(person.skeleton.joints.size());
  const TargetNames names = targetNames(person.skeleton, none, bones, BoneNames::kUnreal, NameStyle::kSnake);
  EXPECT_EQ(names.joints, namesOf(person.skeleton));
}

TEST(TargetNames, ABoneThatIsReadInAClothDoesNotTakeTheNameOfTheLeg) {
  const testing::TargetPerson person(testing::wordsOf("mixamo"));
  Skeleton skeleton = person.skeleton;
  std::vector<HumanoidJoint> bones = humanoidJoints(skeleton);
  Joint skirt;
  skirt.name = "J_Sec_Skirt_L_0";
  skirt.parent = skeleton.find("mixamorig:Hips");
  skeleton.joints.push_back(skirt);
  for (HumanoidJoint& bone : bones) {
    if (bone.bone == "leftUpperLeg") bone.joint = skeleton.jointCount() - 1;
  }
  const Anatomy none = unread(skeleton.joints.size());
  const TargetNames names = targetNames(skeleton, none, bones, BoneNames::kMixamo, NameStyle::kMixamo);
  EXPECT_EQ(names.joints, namesOf(skeleton));
}

TEST(TargetNames, ThumbsOfUnityAreNamedAsTheyAreReadForGodot) {
  const Skeleton unity = testing::TargetPerson(testing::wordsOf("unity")).skeleton, godot = renamed(unity, "godot");
  EXPECT_EQ(godot.joints[*unity.find("LeftThumbProximal")].name, "LeftThumbMetacarpal");
  EXPECT_EQ(godot.joints[*unity.find("LeftThumbIntermediate")].name, "LeftThumbProximal");
  EXPECT_EQ(godot.joints[*unity.find("RightHand")].name, "RightHand");
}

// MetaHuman's last joint of the spine carries neck and clavicles; the mannequin of Unreal Engine 4 has three.
TEST(TargetNames, SpreadsAShortSpineOverMetaHumans) {
  const Skeleton skeleton = chain({"pelvis", "spine_01", "spine_02", "spine_03", "neck_01", "head"});
  const std::vector<HumanoidJoint> bones = {{"hips", 0},       {"spine", 1}, {"chest", 2},
                                            {"upperChest", 3}, {"neck", 4},  {"head", 5}};
  const Anatomy none = unread(6);
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kMetaHuman, NameStyle::kSnake).joints,
              ElementsAre("pelvis", "spine_01", "spine_03", "spine_05", "neck_01", "head"));
}

TEST(TargetNames, RigifyCountsFromTheHipsToTheHead) {
  const Skeleton skeleton = chain({"p", "a", "b", "n", "h"});
  const std::vector<HumanoidJoint> bones = {{"hips", 0}, {"spine", 1}, {"chest", 2}, {"neck", 3}, {"head", 4}};
  const Anatomy none = unread(5);
  EXPECT_THAT(targetNames(skeleton, none, bones, BoneNames::kRigify, NameStyle::kRigify).joints,
              ElementsAre("DEF-spine", "DEF-spine.001", "DEF-spine.002", "DEF-spine.003", "DEF-spine.004"));
}

TEST(TargetNames, KeepsNamesApart) {
  const Skeleton skeleton = chain({"Hand.L", "hand_L", "lHand", "\xe6\x89\x8b"});
  const Anatomy none = unread(4);
  EXPECT_THAT(targetNames(skeleton, none, {}, BoneNames::kUnreal, NameStyle::kSnake).joints,
              ElementsAre("hand_l", "hand_l_2", "hand_l_3", "\xe6\x89\x8b"));
}

}  // namespace
}  // namespace limber
