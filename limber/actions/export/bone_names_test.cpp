#include "limber/actions/export/bone_names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/export/engine_target.h"
#include "limber/actions/export/testing/target_people.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(BoneNames, HasTheNamesOfEachProgramsSkeleton) {
  for (const testing::TargetWords& words : testing::targetWords()) {
    const EngineTarget& target = findTarget(words.target);
    const std::set<std::string> own = ownNames(target.boneNames, target.style);
    for (const Joint& joint : testing::TargetPerson(words).skeleton.joints) {
      EXPECT_EQ(own.count(joint.name), 1u) << words.target << ' ' << joint.name;
    }
    EXPECT_EQ(own.count("J_Sec_Skirt_L_0"), 0u);
  }
}

TEST(BoneNames, NamesBonesOfVrm) {
  EXPECT_EQ(boneName("leftLittleDistal", BoneNames::kActorCore, NameStyle::kActorCore), "CC_Base_L_Pinky3");
  EXPECT_EQ(boneName("rightToes", BoneNames::kRigify, NameStyle::kRigify), "DEF-toe.R");
  EXPECT_EQ(boneName("hips", BoneNames::kRoblox, NameStyle::kPascal), "LowerTorso");
  EXPECT_EQ(boneName("tail", BoneNames::kRoblox, NameStyle::kPascal), std::nullopt);
}

TEST(BoneNames, CountsTheTrunkWhereTheProgramDoes) {
  EXPECT_THAT(trunkNames(4, 1, BoneNames::kActorCore, NameStyle::kActorCore),
              ElementsAre("CC_Base_Hip", "CC_Base_Waist", "CC_Base_Spine01", "CC_Base_Spine02", "CC_Base_Spine03",
                          "CC_Base_NeckTwist01", "CC_Base_Head"));
  EXPECT_THAT(trunkNames(2, 1, BoneNames::kMetaHuman, NameStyle::kSnake),
              ElementsAre("pelvis", "spine_01", "spine_05", "neck_01", "head"));
  EXPECT_THAT(trunkNames(2, 1, BoneNames::kGodot, NameStyle::kPascal), IsEmpty());
}

TEST(BoneNames, SeesGapsInWhatIsCounted) {
  EXPECT_TRUE(isCountedAsOwn({"spine_01", "spine_02", "neck_01"}, BoneNames::kUnreal, NameStyle::kSnake));
  EXPECT_FALSE(isCountedAsOwn({"spine_01", "spine_03"}, BoneNames::kUnreal, NameStyle::kSnake));
  EXPECT_FALSE(isCountedAsOwn({"spine_01", "spine_02"}, BoneNames::kMetaHuman, NameStyle::kSnake));
  EXPECT_TRUE(isCountedAsOwn({"spine_01", "spine_05"}, BoneNames::kMetaHuman, NameStyle::kSnake));
}

TEST(BoneNames, NamesThePalm) {
  EXPECT_EQ(metacarpalName("little", Side::kLeft, BoneNames::kUnreal, NameStyle::kSnake), "pinky_metacarpal_l");
  EXPECT_EQ(metacarpalName("little", Side::kRight, BoneNames::kRigify, NameStyle::kRigify), "DEF-palm.04.R");
}

}  // namespace
}  // namespace limber
