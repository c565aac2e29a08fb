#include "limber/skeleton/humanoid_names.h"

#include <map>
#include <string>

#include <gmock/gmock.h>

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::Pair;

// "hips(spine(head) legL(footL))": names with their children in brackets.
Skeleton parse(const std::string& text) {
  Skeleton skeleton;
  std::vector<Index> open;
  std::string name;
  const auto close = [&] {
    if (name.empty()) return;
    Joint joint;
    joint.name = name;
    if (!open.empty()) joint.parent = open.back();
    skeleton.joints.push_back(joint);
    name.clear();
  };
  for (const char c : text) {
    if (c == '(') {
      close();
      open.push_back(skeleton.jointCount() - 1);
    } else if (c == ')' || c == ',') {
      close();
      if (c == ')') open.pop_back();
    } else {
      name.push_back(c);
    }
  }
  close();
  return skeleton;
}

std::map<std::string, std::string> bonesByName(const std::string& text) {
  const Skeleton skeleton = parse(text);
  checkSkeleton(skeleton);
  std::map<std::string, std::string> bones;
  for (const HumanoidJoint& joint : humanoidJointsByName(skeleton)) {
    bones[std::string(joint.bone)] = skeleton.joints[joint.joint].name;
  }
  return bones;
}

std::vector<std::pair<std::string, std::string>> pairs(
    std::initializer_list<std::pair<std::string, std::string>> list) {
  return {list.begin(), list.end()};
}

TEST(HumanoidNames, MixamoShouldersAreCollars) {
  EXPECT_THAT(
      bonesByName("mixamorig:Hips(mixamorig:Spine(mixamorig:Spine1(mixamorig:Spine2(mixamorig:Neck(mixamorig:Head("
                  "mixamorig:HeadTop_End)),mixamorig:LeftShoulder(mixamorig:LeftArm(mixamorig:LeftForeArm("
                  "mixamorig:LeftHand(mixamorig:LeftHandThumb1(mixamorig:LeftHandThumb2(mixamorig:LeftHandThumb3("
                  "mixamorig:LeftHandThumb4)))))))))),mixamorig:LeftUpLeg(mixamorig:LeftLeg(mixamorig:LeftFoot("
                  "mixamorig:LeftToeBase))),mixamorig:RightUpLeg(mixamorig:RightLeg))"),
      IsSupersetOf(pairs({{"hips", "mixamorig:Hips"},
                          {"spine", "mixamorig:Spine"},
                          {"chest", "mixamorig:Spine1"},
                          {"upperChest", "mixamorig:Spine2"},
                          {"head", "mixamorig:Head"},
                          {"leftShoulder", "mixamorig:LeftShoulder"},
                          {"leftUpperArm", "mixamorig:LeftArm"},
                          {"leftLowerArm", "mixamorig:LeftForeArm"},
                          {"leftThumbMetacarpal", "mixamorig:LeftHandThumb1"},
                          {"leftThumbDistal", "mixamorig:LeftHandThumb3"},
                          {"leftUpperLeg", "mixamorig:LeftUpLeg"},
                          {"leftLowerLeg", "mixamorig:LeftLeg"},
                          {"leftToes", "mixamorig:LeftToeBase"}})));
}

TEST(HumanoidNames, ShouldersBelowCollarsAreUpperArms) {
  EXPECT_THAT(bonesByName("Hips(Chest(Neck(Head),LeftCollar(LeftShoulder(LeftElbow(LeftWrist)))),LeftHip(LeftKnee("
                          "LeftAnkle(LeftToe))),RightHip(RightKnee))"),
              IsSupersetOf(pairs({{"hips", "Hips"},
                                  {"spine", "Chest"},
                                  {"leftShoulder", "LeftCollar"},
                                  {"leftUpperArm", "LeftShoulder"},
                                  {"leftLowerArm", "LeftElbow"},
                                  {"leftHand", "LeftWrist"},
                                  {"leftUpperLeg", "LeftHip"},
                                  {"leftLowerLeg", "LeftKnee"},
                                  {"leftFoot", "LeftAnkle"},
                                  {"leftToes", "LeftToe"}})));
}

TEST(HumanoidNames, LinksBetweenHipsAndLegsPlayNothing) {
  for (const char* text :
       {"Hips(LHipJoint(LeftUpLeg(LeftLeg(LeftFoot))),RHipJoint(RightUpLeg(RightLeg)),LowerBack(Spine(Neck(Head))))",
        "Hips(LHipJoint(LeftHip(LeftKnee(LeftAnkle))),RHipJoint(RightHip(RightKnee)),lowerback(Chest(Neck(Head))))"}) {
    const auto bones = bonesByName(text);
    EXPECT_THAT(bones, Contains(Pair("hips", "Hips")));
    EXPECT_THAT(bones.at("leftUpperLeg"), ::testing::StartsWith("Left"));
    EXPECT_THAT(bones.at("rightUpperLeg"), ::testing::StartsWith("Right"));
  }
}

TEST(HumanoidNames, SidesStandAnywhere) {
  for (const char* upper : {"upperarm_l", "l_upperarm", "UpperArm.L", "Bip01 L UpperArm", "ValveBiped.Bip01_L_UpperArm",
                            "J_Bip_L_UpperArm", "DEF-upper_arm.L", "CC_Base_L_Upperarm", "lShldrBend", "LUArm",
                            "hero_upper_arm_left", "Left arm", "lhumerus", "b_LeftUpperArm_09"}) {
    const auto bones = bonesByName(upper);
    EXPECT_THAT(bones, Contains(Pair("leftUpperArm", upper)));
  }
}

TEST(HumanoidNames, HelpersPlayNothing) {
  const auto bones = bonesByName(
      "root(pelvis(spine_01(neck_01(head(head_leaf))),thigh_l(thigh_twist_01_l,calf_l(calf_twist_01_l,foot_l("
      "ball_l(ball_leaf_l)),ik_foot_l)),thigh_r(calf_r)),FootTarget.L,PoleTarget.L,handslot.l)");
  EXPECT_THAT(bones, IsSupersetOf(pairs({{"hips", "pelvis"}, {"leftLowerLeg", "calf_l"}, {"leftToes", "ball_l"}})));
  for (const auto& [bone, name] : bones) {
    EXPECT_THAT(name, AllOf(Not(::testing::HasSubstr("twist")), Not(::testing::HasSubstr("leaf")),
                            Not(::testing::HasSubstr("Target")), Not(::testing::HasSubstr("ik_"))))
        << bone;
  }
}

TEST(HumanoidNames, FingersByNumber) {
  EXPECT_THAT(bonesByName("Bip01 L Hand(Bip01 L Finger0(Bip01 L Finger01(Bip01 L Finger02)),Bip01 L Finger1("
                          "Bip01 L Finger11),Bip01 L Finger4)"),
              IsSupersetOf(pairs({{"leftThumbDistal", "Bip01 L Finger02"},
                                  {"leftIndexIntermediate", "Bip01 L Finger11"},
                                  {"leftLittleProximal", "Bip01 L Finger4"}})));
  EXPECT_THAT(
      bonesByName("wrist.R(finger1-1.R(finger1-2.R(finger1-3.R)),metacarpal1.R(finger2-1.R(finger2-2.R)))"),
      IsSupersetOf(pairs({{"rightThumbMetacarpal", "finger1-1.R"}, {"rightIndexIntermediate", "finger2-2.R"}})));
}

TEST(HumanoidNames, LimbsCountedFromTheBody) {
  EXPECT_THAT(bonesByName("torso_joint_1(leg_joint_R_1(leg_joint_R_2(leg_joint_R_3(leg_joint_R_5))),leg_joint_L_1("
                          "leg_joint_L_2),torso_joint_2(arm_joint_L__4_(arm_joint_L__3_(arm_joint_L__2_)),"
                          "neck_joint_1(neck_joint_2)))"),
              IsSupersetOf(pairs({{"hips", "torso_joint_1"},
                                  {"rightUpperLeg", "leg_joint_R_1"},
                                  {"rightFoot", "leg_joint_R_3"},
                                  {"rightToes", "leg_joint_R_5"},
                                  {"leftUpperArm", "arm_joint_L__4_"},
                                  {"leftHand", "arm_joint_L__2_"},
                                  {"head", "neck_joint_2"}})));
}

// Of which the foot may have a name of its own, and a root of its own.
TEST(HumanoidNames, CountedLegsEndAtTheFoot) {
  const auto bones = bonesByName("Root(Body(Head,Leg1.L(Leg2.L(Leg3.L)),Leg1.R(Leg2.R(Leg3.R(Foot.R)))),Foot.L)");
  EXPECT_EQ(bones.at("leftUpperLeg"), "Leg1.L");
  EXPECT_EQ(bones.at("leftLowerLeg"), "Leg3.L");
  EXPECT_EQ(bones.at("leftFoot"), "Foot.L");
  EXPECT_EQ(bones.at("rightFoot"), "Foot.R");
  EXPECT_FALSE(bones.contains("rightToes"));
}

TEST(HumanoidNames, TheHipsAreWhereLegsAndTrunkPart) {
  const auto bones = bonesByName("Root(Spine1(Spine2(Neck(Head))),Hips(UpLeg_L(LoLeg_L),UpLeg_R(LoLeg_R)))");
  EXPECT_EQ(bones.at("hips"), "Root") << "the one called Hips carries no trunk";
  EXPECT_EQ(bones.at("spine"), "Spine1");
}

TEST(HumanoidNames, ThePelvisIsWhereItIsCalledSo) {
  const auto pelvis = [](const std::string& text) {
    const Skeleton skeleton = parse(text);
    return skeleton.joints[pelvisByName(skeleton).value()].name;
  };
  const std::string legs = "UpperLeg.L(LowerLeg.L(Foot.L)),UpperLeg.R(LowerLeg.R(Foot.R))";
  EXPECT_EQ(pelvis("Root(Hips(Abdomen(Torso(Neck(Head))))," + legs + ")"), "Hips");
  EXPECT_EQ(pelvis("Root(Abdomen(Torso(Neck(Head)))," + legs + ")"), "Root");
  EXPECT_EQ(pelvis("Hips(Abdomen(Torso(Neck(Head)))," + legs + ")"), "Hips");
  EXPECT_FALSE(pelvisByName(parse("a(b)")).has_value());
  // What moves the legs still plays the hips, and what is called hips is no spine.
  const auto bones = bonesByName("Root(Hips(Abdomen(Torso(Neck(Head))))," + legs + ")");
  EXPECT_EQ(bones.at("hips"), "Root");
  EXPECT_EQ(bones.at("spine"), "Abdomen");
}

// The knee bends forward and the hock back.
TEST(HumanoidNames, OfThreeBonesInALegTheLastIsTheFoot) {
  const auto bones = bonesByName(
      "Body(Torso(Neck(Head)),UpperLeg.L(MidLeg.L(LowerLeg.L(Foot.L))),UpperLeg.R(MidLeg.R(LowerLeg.R(Foot.R))))");
  EXPECT_EQ(bones.at("leftUpperLeg"), "UpperLeg.L");
  EXPECT_EQ(bones.at("leftLowerLeg"), "MidLeg.L");
  EXPECT_EQ(bones.at("leftFoot"), "LowerLeg.L");
  EXPECT_EQ(bones.at("leftToes"), "Foot.L");
  EXPECT_EQ(bones.at("rightLowerLeg"), "MidLeg.R");
  // Beside the others it is a helper.
  const auto aside = bonesByName("Body(Torso(Neck(Head)),UpperLeg.L(LowerLeg.L(Foot.L),MidLeg.L),UpperLeg.R)");
  EXPECT_EQ(aside.at("leftLowerLeg"), "LowerLeg.L");
  EXPECT_EQ(aside.at("leftFoot"), "Foot.L");
}

TEST(HumanoidNames, AnimalsLegsAreNoPeoples) {
  const auto bones = bonesByName(
      "hips(spine_1(front_leg_upper_l(front_leg_lower_l(front_leg_foot_l)),head),"
      "back_leg_upper_l(back_leg_lower_l(back_leg_foot_l)),BackLeg.L,FrontUpperLeg.R)");
  for (const auto& [bone, name] : bones) EXPECT_THAT(bone, Not(::testing::HasSubstr("Leg"))) << name;
}

TEST(HumanoidNames, AmbiguousNamesAreLessSure) {
  const Skeleton skeleton = parse("Hips(Spine(Neck(Head),LeftShoulder(LeftElbow)),LeftUpLeg,RightUpLeg)");
  double upperArm = 1, hips = 0;
  for (const HumanoidJoint& joint : humanoidJointsByName(skeleton)) {
    if (joint.bone == "leftUpperArm") upperArm = joint.confidence;
    if (joint.bone == "hips") hips = joint.confidence;
  }
  EXPECT_LT(upperArm, hips);
}

TEST(HumanoidNames, TheTableIsATree) {
  for (const std::string_view bone : humanoidBones()) {
    EXPECT_EQ(mirroredBone(mirroredBone(bone)), bone);
    int steps = 0;
    for (auto up = humanoidParent(bone); up; up = humanoidParent(*up)) ASSERT_LT(++steps, 20) << bone;
  }
  EXPECT_EQ(humanoidBones().size(), 55U);
  EXPECT_EQ(mirroredBone("leftToes"), "rightToes");
  EXPECT_EQ(mirroredBone("head"), "head");
}

}  // namespace
}  // namespace limber
