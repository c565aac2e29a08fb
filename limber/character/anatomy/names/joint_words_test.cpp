#include "limber/character/anatomy/names/joint_words.h"

#include <gtest/gtest.h>

#include <string>

#include "limber/character/anatomy/names/humanoid_words.h"
#include "limber/character/anatomy/testing/bodies.h"

namespace limber {
namespace {

using detail::BodyWord;
using limber::testing::addJoint;

std::size_t wordOf(std::string_view name) {
  return readJointWords(name).word;
}

// VRM, Mixamo, CMU, Unreal, 3ds Max Biped, Rigify, Maya and Auto-Rig Pro.
TEST(JointWords, PeoplesOfManyMakers) {
  const struct {
    const char* name;
    BodyWord word;
    Side side;
  } rows[] = {
      {"hips", BodyWord::kHips, Side::kCenter},
      {"mixamorig:Hips", BodyWord::kHips, Side::kCenter},
      {"Bip01 Pelvis", BodyWord::kHips, Side::kCenter},
      {"spine_02", BodyWord::kTrunk, Side::kCenter},
      {"upperChest", BodyWord::kTrunk, Side::kCenter},
      {"Bip01 Neck", BodyWord::kNeck, Side::kCenter},
      {"mixamorig:Head", BodyWord::kHead, Side::kCenter},
      {"leftUpperArm", BodyWord::kUpperArm, Side::kLeft},
      {"upperarm_l", BodyWord::kUpperArm, Side::kLeft},
      {"Bip01 R UpperArm", BodyWord::kUpperArm, Side::kRight},
      {"upper_arm.R", BodyWord::kUpperArm, Side::kRight},
      {"mixamorig:LeftForeArm", BodyWord::kLowerArm, Side::kLeft},
      {"lowerarm_r", BodyWord::kLowerArm, Side::kRight},
      {"forearm.L", BodyWord::kLowerArm, Side::kLeft},
      {"hand_l", BodyWord::kHand, Side::kLeft},
      {"clavicle_r", BodyWord::kCollar, Side::kRight},
      {"Bip01 L Clavicle", BodyWord::kCollar, Side::kLeft},
      {"thigh_l", BodyWord::kUpperLeg, Side::kLeft},
      {"mixamorig:RightUpLeg", BodyWord::kUpperLeg, Side::kRight},
      {"calf_r", BodyWord::kLowerLeg, Side::kRight},
      {"shin.L", BodyWord::kLowerLeg, Side::kLeft},
      {"LeftFoot", BodyWord::kFoot, Side::kLeft},
      {"ball_l", BodyWord::kToes, Side::kLeft},
      {"LeftToeBase", BodyWord::kToes, Side::kLeft},
      {"leftThumbProximal", BodyWord::kThumb, Side::kLeft},
      {"index_01_r", BodyWord::kIndex, Side::kRight},
  };
  for (const auto& row : rows) {
    const JointWords words = readJointWords(row.name);
    EXPECT_EQ(words.word, static_cast<std::size_t>(row.word)) << row.name;
    EXPECT_EQ(words.side, row.side) << row.name;
  }
}

TEST(JointWords, AnimalsPartsHaveWordsOfTheirOwn) {
  for (const auto& [one, other] : {std::pair{"Tail1", "rig:tail_07"},
                                   {"LeftWing2", "Wing.R.003"},
                                   {"DorsalFin", "fin_L"},
                                   {"Ear1.R", "ears"},
                                   {"Beak", "mouth"},
                                   {"ponytail_03", "Hair.L"},
                                   {"sword", "Weapon_R"},
                                   {"Root", "Armature"},
                                   {"paw.L", "hoof_r"},
                                   {"skirt_01", "Cape"}}) {
    EXPECT_NE(wordOf(one), 0u) << one;
    EXPECT_EQ(wordOf(one), wordOf(other)) << one << ' ' << other;
    EXPECT_LT(wordOf(one), kJointWords);
  }
  EXPECT_NE(wordOf("Tail1"), wordOf("Wing1"));
}

TEST(JointWords, WhatSaysNothingHasNoWord) {
  for (const char* name : {"", "q7", "joint12", "Bone.003", "b0LeftOne", "node", "Kabel", "___", "123"}) {
    EXPECT_EQ(wordOf(name), 0u) << name;
  }
}

TEST(JointWords, MarksTellHelpersEndsAndTwists) {
  EXPECT_TRUE(readJointWords("LeftFoot_IK").has(NameMark::kHelper));
  EXPECT_TRUE(readJointWords("knee_pole.L").has(NameMark::kHelper));
  EXPECT_TRUE(readJointWords("HeadTop_End").has(NameMark::kEnd));
  EXPECT_TRUE(readJointWords("Bip01 HeadNub").has(NameMark::kEnd) ||
              readJointWords("Bip01 Head Nub").has(NameMark::kEnd));
  EXPECT_TRUE(readJointWords("upperarm_twist_01_l").has(NameMark::kTwist));
  EXPECT_TRUE(readJointWords("spine_03").has(NameMark::kNumbered));
  EXPECT_TRUE(readJointWords("FrontLeg.L").has(NameMark::kFront));
  EXPECT_TRUE(readJointWords("Hind_leg").has(NameMark::kHind));
  const JointWords plain = readJointWords("leftFoot");
  for (const NameMark mark : {NameMark::kFront, NameMark::kHind, NameMark::kEnd, NameMark::kHelper, NameMark::kTwist}) {
    EXPECT_FALSE(plain.has(mark));
  }
}

TEST(JointWords, HipsAreCalledSo) {
  for (const char* name : {"hips", "Pelvis", "mixamorig:Hips", "Bip01 Pelvis"}) EXPECT_TRUE(saysHips(name)) << name;
  for (const char* name : {"head", "LeftUpLeg", "", "spine"}) EXPECT_FALSE(saysHips(name)) << name;
}

TEST(JointWords, FingersAreCountedFromTheThumb) {
  Index expected = 0;
  for (const char* name :
       {"leftThumbProximal", "leftIndexProximal", "leftMiddleProximal", "leftRingProximal", "leftLittleProximal"}) {
    EXPECT_EQ(fingerOfWord(wordOf(name)), expected++) << name;
  }
  EXPECT_FALSE(fingerOfWord(wordOf("leftHand")));
  EXPECT_FALSE(fingerOfWord(0));
}

TEST(JointWords, PartnersDifferInTheirSideAlone) {
  for (const limber::testing::NameHabit habit : limber::testing::kNameHabits) {
    const limber::testing::MadeBody person = limber::testing::personWith(habit);
    const std::vector<std::optional<NamedPartner>> partners =
        partnersByName(person.skeleton, wordsOfJoints(person.skeleton));
    ASSERT_EQ(partners.size(), person.skeleton.joints.size());
    for (Index j = 0; j < partners.size(); ++j) {
      const std::string& name = person.skeleton.joints[j].name;
      ASSERT_EQ(partners[j].has_value(), person.parts[j].side != Side::kCenter) << name;
      if (!partners[j]) continue;
      EXPECT_EQ(partners[j]->isLeft, person.parts[j].side == Side::kLeft) << name;
      EXPECT_EQ(person.parts[partners[j]->partner].segment, person.parts[j].segment) << name;
      EXPECT_EQ(partners[partners[j]->partner]->partner, j) << name;
    }
  }
}

TEST(JointWords, NamesThatTwoJointsShareButForCasePairNothing) {
  Skeleton skeleton;
  for (const char* name : {"arm.L", "Arm_L", "arm.R", "leg.L", "leg.R", "tail"}) {
    addJoint(skeleton, name, skeleton.joints.empty() ? "" : "arm.L", Vec3::UnitX());
  }
  const std::vector<std::optional<NamedPartner>> partners = partnersByName(skeleton, wordsOfJoints(skeleton));
  for (const Index joint : {0u, 1u, 2u, 5u}) EXPECT_FALSE(partners[joint]) << skeleton.joints[joint].name;
  ASSERT_TRUE(partners[3]);
  EXPECT_EQ(partners[3]->partner, 4u);
}

}  // namespace
}  // namespace limber
