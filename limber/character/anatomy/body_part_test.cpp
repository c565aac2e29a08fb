#include "limber/character/anatomy/body_part.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {
namespace {

std::vector<BodyPart> everyPart() {
  std::vector<BodyPart> parts;
  for (std::size_t k = 0; k < kPartKinds; ++k) {
    const auto kind = static_cast<PartKind>(k);
    if (kind == PartKind::kOther) continue;
    const bool limb = kind == PartKind::kLeg || kind == PartKind::kArm;
    for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
      for (int segment = 0; segment < 7; ++segment) {
        if (segment > 0 && !limb && !(kind == PartKind::kTrunk && segment == 1)) continue;
        for (Index pair = 0; pair < 8; ++pair) {
          for (Index piece = 0; piece < 12; ++piece)
            parts.push_back({kind, side, pair, static_cast<Segment>(segment), piece});
        }
      }
    }
  }
  return parts;
}

TEST(BodyPart, EveryNameIsOfOnePart) {
  std::set<std::string> names;
  for (const BodyPart& part : everyPart()) EXPECT_TRUE(names.insert(nameOf(part)).second) << nameOf(part);
}

TEST(BodyPart, NamesRoundTrip) {
  for (const BodyPart& part : everyPart()) {
    const std::optional<BodyPart> read = bodyPartNamed(nameOf(part));
    EXPECT_TRUE(read && *read == part) << nameOf(part);
  }
}

TEST(BodyPart, PeoplesAreThoseOfVrm) {
  EXPECT_EQ(nameOf(body_part::kPelvis), "hips");
  EXPECT_EQ(nameOf(body_part::kTrunk), "trunk");
  EXPECT_EQ(nameOf(body_part::arm(Side::kLeft, Segment::kBase)), "leftShoulder");
  EXPECT_EQ(nameOf(body_part::leg(Side::kRight, Segment::kToes)), "rightToes");
  EXPECT_EQ(nameOf(body_part::leg(Side::kLeft, Segment::kUpper, 1)), "leftUpperLeg2");
  EXPECT_EQ(nameOf({PartKind::kWing, Side::kRight, 0, Segment::kWhole, 2}), "rightWingPiece3");
  for (const std::string_view bone : humanoidBones()) {
    if (bone == "spine" || bone == "chest" || bone == "upperChest") continue;  // joints of the trunk
    const std::optional<BodyPart> part = bodyPartNamed(bone);
    ASSERT_TRUE(part) << bone;
    EXPECT_EQ(nameOf(*part), bone);
  }
}

TEST(BodyPart, OtherNamesAreNone) {
  for (const char* name : {"", "left", "Hips", "LeftFoot", "leftUpperLeg1", "leftUpperLeg02", "leftUpperLegPiece1",
                           "leftUpperLegPiece", "tailPiece0", "spine", "other", "leftOther", "upper", "Piece2", "2",
                           "leftUpperLeg99999999999999999999", "leftUpperLegPiece99999999999999999999", "tail 2"}) {
    EXPECT_FALSE(bodyPartNamed(name)) << name;
  }
}

TEST(BodyPart, LabelsAreAsOneSaysThem) {
  const auto labelIn = [](const Skeleton& skeleton, const char* joint) {
    return labelOf(readAnatomy(skeleton), skeleton.find(joint).value());
  };
  const Skeleton person = testing::vrmPerson();
  EXPECT_EQ(labelIn(person, "leftUpperArm"), "left upper arm");
  EXPECT_EQ(labelIn(person, "rightToes"), "right toes");
  EXPECT_EQ(labelIn(person, "leftShoulder"), "left shoulder");
  EXPECT_EQ(labelIn(person, "head"), "head");
  const Skeleton animal = testing::quadruped(0.5);
  EXPECT_EQ(labelIn(animal, "b1LeftOne"), "left front upper leg");
  EXPECT_EQ(labelIn(animal, "b0RightTwo"), "right hind lower leg");
  EXPECT_EQ(labelIn(animal, "tail2"), "tail");
  const Skeleton spider = testing::spider().skeleton;
  const Anatomy anatomy = readAnatomy(spider);
  std::set<std::string> labels;
  for (Index j = 0; j < spider.jointCount(); ++j) labels.insert(labelOf(anatomy, j));
  EXPECT_TRUE(labels.count("left foot"));
  EXPECT_TRUE(labels.count("right foot 4"));
}

TEST(BodyPart, KindsAndSidesHaveNames) {
  for (std::size_t k = 0; k < kPartKinds; ++k) {
    const auto kind = static_cast<PartKind>(k);
    EXPECT_EQ(partKindNamed(nameOf(kind)), kind);
  }
  for (const Side side : {Side::kCenter, Side::kLeft, Side::kRight}) {
    EXPECT_EQ(sideNamed(nameOf(side)), side);
    EXPECT_EQ(opposite(opposite(side)), side);
  }
  EXPECT_FALSE(partKindNamed("legs"));
  EXPECT_FALSE(sideNamed(""));
}

}  // namespace
}  // namespace limber
