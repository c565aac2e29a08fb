#include "limber/character/anatomy/names/naming_convention.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "limber/character/anatomy/anatomy.h"
#include "limber/character/anatomy/testing/convention_bodies.h"

namespace limber {
namespace {

using testing::PersonVariant;

// What the reading takes a joint for, in the words of the made body.
BodyPart readPart(const Anatomy& anatomy, Index joint) {
  const std::optional<BodyPart> part = bodyPartAt(anatomy, joint);
  return part.value_or(BodyPart{PartKind::kOther, Side::kCenter, 0, Segment::kWhole, 0});
}

bool isRight(const BodyPart& truth, const BodyPart& read) {
  const bool isLimb = truth.kind == PartKind::kLeg || truth.kind == PartKind::kArm;
  if (truth.kind != read.kind || truth.side != read.side) return false;
  if (truth.kind == PartKind::kFinger || isLimb) {
    if (truth.pair != read.pair) return false;
  }
  return !isLimb || truth.segment == read.segment;
}

TEST(NamingConvention, EveryVariantOfEveryOneIsReadRight) {
  for (const NamingConvention& convention : namingConventions()) {
    if (!testing::isOfPeople(convention)) continue;
    for (const PersonVariant& variant : testing::personVariants()) {
      const testing::MadeBody body = testing::personOf(convention, variant);
      const Anatomy anatomy = readAnatomy(body.skeleton);
      EXPECT_FALSE(anatomy.convention.empty()) << convention.name;
      EXPECT_TRUE(anatomy.contradicted.empty()) << convention.name;
      EXPECT_EQ(anatomy.pairsOf(PartKind::kLeg), 1u) << convention.name;
      EXPECT_EQ(anatomy.pairsOf(PartKind::kArm), 1u) << convention.name;
      for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
        if (body.parts[j].kind == PartKind::kOther) continue;
        EXPECT_TRUE(isRight(body.parts[j], readPart(anatomy, j)))
            << convention.name << ", " << variant.spines << " spines: " << body.skeleton.joints[j].name
            << " is read as " << labelOf(anatomy, j);
      }
    }
  }
}

TEST(NamingConvention, ANameMeansOneThingInOneConvention) {
  for (const NamingConvention& convention : namingConventions()) {
    EXPECT_FALSE(convention.documentation.empty()) << convention.name;
    std::map<std::string, JointRole> roles;
    for (const RoleNames& row : convention.roles) {
      for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
        for (std::size_t number = 0; number < 3; ++number) {
          const std::string name = conventionName(convention, row.role, side, number, row.pair);
          if (name.empty()) continue;
          const auto [known, isNew] = roles.emplace(name, row.role);
          EXPECT_TRUE(isNew || known->second == row.role) << convention.name << ": " << name;
        }
      }
    }
  }
}

const NamingConvention& conventionCalled(std::string_view name) {
  return *std::ranges::find(namingConventions(), name, &NamingConvention::name);
}

TEST(NamingConvention, NamesAreCountedBehindThoseWithoutANumber) {
  const NamingConvention& character = conventionCalled("Character Creator");
  EXPECT_EQ(conventionName(character, JointRole::kTrunk, Side::kCenter, 0), "CC_Base_Waist");
  EXPECT_EQ(conventionName(character, JointRole::kTrunk, Side::kCenter, 1), "CC_Base_Spine01");
  EXPECT_EQ(conventionName(character, JointRole::kRoot, Side::kCenter, 0), "RL_BoneRoot");
}

TEST(NamingConvention, VariantsAreReadAndNotWritten) {
  const NamingConvention& unity = conventionCalled("Unity");
  EXPECT_EQ(conventionNames(unity, JointRole::kToes, Side::kLeft, 9), std::vector<std::string>{"LeftToes"});
  EXPECT_EQ(conventionName(unity, JointRole::kTrunk, Side::kCenter, 3), "");
  Skeleton skeleton = testing::personOf(unity, {}).skeleton;
  const Index toes = skeleton.find("LeftToes").value();
  skeleton.joints[toes].name = "LeftToeBase";
  const std::optional<ConventionMatch> match = findConvention(skeleton);
  ASSERT_TRUE(match && match->roles[toes]);
  EXPECT_EQ(match->roles[toes]->role, JointRole::kToes);
}

// What its names say is certain.
TEST(NamingConvention, NamedLimbsAreSure) {
  const testing::MadeBody body = testing::personOf(namingConventions().front(), testing::personVariants()[5]);
  const Anatomy anatomy = readAnatomy(body.skeleton);
  EXPECT_EQ(anatomy.convention, "Mixamo");
  for (const PartKind kind : {PartKind::kLeg, PartKind::kArm}) {
    for (const Side side : kSides) {
      const Part* limb = anatomy.find(kind, side);
      ASSERT_TRUE(limb);
      EXPECT_GT(limb->confidence, 0.999);
    }
  }
}

TEST(NamingConvention, AnyPrefixAndNumbersOfExportersArePassedOver) {
  const Skeleton plain = testing::personOf(namingConventions().front(), {}).skeleton;
  const auto renamed = [&](const auto& rename) {
    Skeleton skeleton = plain;
    for (Index j = 0; j < skeleton.jointCount(); ++j) skeleton.joints[j].name = rename(skeleton.joints[j].name, j);
    return skeleton;
  };
  const auto bare = [](const std::string& name) { return name.substr(name.find(':') + 1); };
  for (const Skeleton& skeleton :
       {renamed([&](const std::string&name, Index) { return bare(name); }),
        renamed([&](const std::string&name, Index) { return "mixamorig7:" + bare(name); }),
        renamed([&](const std::string&name, Index) { return "mixamorig" + bare(name); }),
        renamed([&](const std::string&name, Index) { return "Hero_" + bare(name); }),
        renamed([&](const std::string&name, Index j) { return name + "_0" + std::to_string(j + 3); })}) {
    const std::optional<ConventionMatch> match = findConvention(skeleton);
    ASSERT_TRUE(match) << skeleton.joints[3].name;
    EXPECT_EQ(match->convention->name, "Mixamo") << skeleton.joints[3].name;
    for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_TRUE(match->roles[j]) << skeleton.joints[j].name;
  }
}

// Of conventions that have most names in common, the one whose prefix they have, whatever ends and attachments are
// called.
TEST(NamingConvention, ThePrefixTellsWhose) {
  Skeleton skeleton = testing::personOf(namingConventions().front(), {}).skeleton;
  for (const char* end : {"mixamorig:LeftToeEnd", "mixamorig:RightToeEnd", "mixamorig:HeadEnd"}) {
    testing::addJoint(skeleton, end, "mixamorig:Head", {0, 0.1, 0});
  }
  EXPECT_EQ(findConvention(skeleton)->convention->name, "Mixamo");
  for (Joint& joint : skeleton.joints) joint.name = joint.name.substr(joint.name.find(':') + 1);
  EXPECT_EQ(findConvention(skeleton)->convention->name, "MotionBuilder");
}

// Names are evidence, no more, where the tree says otherwise.
TEST(NamingConvention, ATreeThatContradictsNamesIsBelieved) {
  Skeleton skeleton = testing::personOf(namingConventions().front(), {}).skeleton;
  const auto at = [&](const std::string& name) -> Joint& {
    return skeleton.joints[skeleton.find("mixamorig:" + name).value()];
  };
  std::swap(at("LeftUpLeg").name, at("LeftLeg").name);
  const Anatomy anatomy = readAnatomy(skeleton);
  EXPECT_EQ(anatomy.convention, "Mixamo");
  EXPECT_FALSE(anatomy.contradicted.empty());
  const Part* leg = anatomy.find(PartKind::kLeg, Side::kLeft);
  ASSERT_TRUE(leg && leg->upper);
  EXPECT_EQ(skeleton.joints[*leg->upper].name, "mixamorig:LeftLeg");  // the upper one, whatever it is called
}

TEST(NamingConvention, FewNamesAreNoConvention) {
  Skeleton skeleton;
  testing::addJoint(skeleton, "root", "", {0, 0, 0});
  for (int i = 0; i < 12; ++i) {
    testing::addJoint(skeleton, "tail" + std::to_string(i), skeleton.joints.back().name, {0, 0, -0.1});
  }
  EXPECT_FALSE(findConvention(skeleton));
  EXPECT_FALSE(findConvention(Skeleton()));
  EXPECT_FALSE(findConvention(testing::dog().skeleton));
}

}  // namespace
}  // namespace limber
