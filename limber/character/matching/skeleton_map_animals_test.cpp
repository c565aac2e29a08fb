// Which joints of animals follow which: read by their anatomy, whatever they are called.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "limber/character/matching/skeleton_map.h"
#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"

namespace limber {
namespace {

using limber::testing::addJoint;
using limber::testing::chainedAnimal;
using limber::testing::flyer;
using limber::testing::followedBy;
using limber::testing::kBat;
using limber::testing::kGull;
using limber::testing::kNamelessBird;
using limber::testing::matchOf;
using limber::testing::nameless;
using limber::testing::onTheGround;
using limber::testing::quadruped;
using limber::testing::quadrupedOnOneJoint;
using limber::testing::withJointBefore;

using Names = std::vector<std::string>;

const Names kAllPaws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};

Names namesAt(const Skeleton& skeleton, const std::vector<Index>& joints) {
  Names names;
  for (const Index joint : joints) names.push_back(skeleton.joints[joint].name);
  return names;
}

Names sourceOf(const SkeletonMap& map, const Skeleton& source, const char* part) {
  const JointMatch* match = matchOf(map, part);
  return match ? namesAt(source, match->source) : Names();
}

// What is said where they do not match.
std::string refusalOf(const Skeleton& source, const Skeleton& target) {
  try {
    matchSkeletons(source, target);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    return error.what();
  }
  return "";
}

// Its matches by part: the names of what the part follows.
std::map<std::string, Names> followed(const SkeletonMap& map, const Skeleton& source, const Skeleton& target) {
  std::map<std::string, Names> parts;
  for (const JointMatch& match : map.matches) parts[nameOf(match, target)] = namesAt(source, match.source);
  return parts;
}

// One snake has twice the other's joints.
TEST(AnimalMaps, SnakesGoAlongTheirSpines) {
  const Skeleton one = limber::testing::snake().skeleton;
  limber::testing::MadeBody other;
  limber::testing::addChain(other, "Back", 7, "", {0, 0.05, -0.6}, {0, 0, 0.2}, limber::body_part::kPelvis);
  other.add("Skull", "Back7", {0, 0.06, 0.8}, limber::body_part::kHead);
  const SkeletonMap map = matchSkeletons(one, other.skeleton);
  EXPECT_EQ(followed(map, one, other.skeleton)["head"].front(), "Head");
  Index followers = 0;
  for (const JointMatch& match : map.matches) followers += match.target.size();
  EXPECT_EQ(followers, other.skeleton.jointCount());
}

TEST(UnlikeBodies, ForelegsFollowArms) {
  const Skeleton person = limber::testing::vrmPerson(), animal = quadruped(0.5);
  EXPECT_NE(refusalOf(person, animal), "");
  const SkeletonMap map = matchSkeletons(person, animal, true);
  EXPECT_TRUE(map.unlikeBodies);
  EXPECT_TRUE(map.jointByJoint);
  auto parts = followed(map, person, animal);
  EXPECT_EQ(parts["leftUpperLeg"], Names({"leftUpperArm"}));
  EXPECT_EQ(parts["rightLowerLeg"], Names({"rightLowerArm"}));
  EXPECT_EQ(parts["leftUpperLeg2"], Names({"leftUpperLeg"}));
  EXPECT_EQ(parts["rightFoot2"], Names({"rightFoot"}));
  EXPECT_EQ(parts["head"], Names({"head"}));
  parts = followed(matchSkeletons(animal, person, true), animal, person);
  EXPECT_EQ(parts["leftUpperArm"], Names({"b1LeftOne"}));
  EXPECT_EQ(parts["leftUpperLeg"], Names({"b0LeftOne"}));
}

TEST(UnlikeBodies, ASpidersFrontLegsFollowArms) {
  const Skeleton person = limber::testing::vrmPerson(), spider = limber::testing::spider().skeleton;
  auto parts = followed(matchSkeletons(person, spider, true), person, spider);
  EXPECT_EQ(parts["leftUpperLeg"], Names({"leftUpperArm"}));
  EXPECT_EQ(parts["leftUpperLeg4"], Names({"leftUpperLeg"}));
  for (const char* part : {"leftUpperLeg2", "leftUpperLeg3", "rightUpperLeg2", "rightUpperLeg3"})
    EXPECT_EQ(parts[part].size(), 1u) << "limbs may move several";
}

TEST(UnlikeBodies, WingsFollowArms) {
  const Skeleton person = limber::testing::vrmPerson(), bird = limber::testing::crow().skeleton;
  auto parts = followed(matchSkeletons(person, bird, true), person, bird);
  EXPECT_EQ(parts["leftWing"].front(), "leftShoulder");
  EXPECT_EQ(parts["leftUpperLeg"], Names({"leftUpperLeg"}));
}

TEST(UnlikeBodies, ChangesNothingBetweenAlikeOnes) {
  const Skeleton one = quadruped(0.5), other = nameless(quadruped(0.35));
  const SkeletonMap map = matchSkeletons(one, other), asked = matchSkeletons(one, other, true);
  EXPECT_FALSE(asked.unlikeBodies);
  EXPECT_EQ(skeletonMapToJson(asked, one, other), skeletonMapToJson(map, one, other));
}

TEST(UnlikeBodies, StayKnownInAFile) {
  const Skeleton person = limber::testing::vrmPerson(), animal = quadruped(0.5);
  const std::string json = skeletonMapToJson(matchSkeletons(person, animal, true), person, animal);
  EXPECT_TRUE(skeletonMapFromJson(json, person, animal).unlikeBodies);
}

TEST(AnimalMaps, BodyAndLegsOfQuadrupeds) {
  const Skeleton one = quadruped(0.5), other = nameless(quadruped(0.35));
  const SkeletonMap map = matchSkeletons(one, other);
  EXPECT_TRUE(map.isQuadruped());
  EXPECT_EQ(sourceOf(map, one, "hips"), Names({"b0"}));
  EXPECT_EQ(sourceOf(map, one, "trunk"), Names({"b1"}));
  EXPECT_EQ(sourceOf(map, one, "neck"), Names({"n0"}));
  EXPECT_EQ(sourceOf(map, one, "head"), Names({"n1"}));
  EXPECT_EQ(sourceOf(map, one, "tail"), Names({"tail1", "tail2", "tail3"})) << "though it hangs down to the ground";
  EXPECT_EQ(sourceOf(map, one, "leftUpperLeg"), Names({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(map, one, "rightLowerLeg2"), Names({"b0RightTwo"}));
  EXPECT_EQ(sourceOf(map, one, "leftFoot2"), Names({"b0LeftThree"}));
  EXPECT_EQ(sourceOf(map, one, "rightToes"), Names({"b1RightFour"}));
  for (const JointMatch& match : map.matches) EXPECT_EQ(match.source, match.target) << nameOf(match, other);
  EXPECT_TRUE(map.left.empty());
}

TEST(AnimalMaps, TheyAreNotTakenForPeople) {
  const Skeleton one = quadruped(0.5), other = nameless(quadruped(0.45));
  EXPECT_TRUE(matchSkeletons(one, nameless(onTheGround(other, {}))).isQuadruped());
  for (const SkeletonMap& map : {matchSkeletons(one, other), matchSkeletons(other, one)}) {
    EXPECT_FALSE(map.isBiped());
    std::size_t joints = 0;
    for (const JointMatch& match : map.matches) {
      EXPECT_EQ(match.source, match.target);
      joints += match.target.size();
    }
    EXPECT_EQ(joints, one.joints.size()) << "each joint where the trees are the same";
  }
}

TEST(AnimalMaps, PeopleDoNotFollowThem) {
  const Skeleton animal = nameless(quadruped(0.5)), person = practiceHumanoid();
  // What has no partner is named, and the one option that goes on.
  EXPECT_THAT(
      refusalOf(animal, person),
      ::testing::AllOf(::testing::HasSubstr("nothing in the character is like the motion's tail and front legs"),
                       ::testing::HasSubstr("nothing in the motion is like the character's arms"),
                       ::testing::EndsWith("(--unlike-bodies lets limbs follow others)")));
  EXPECT_THAT(refusalOf(person, animal),
              ::testing::HasSubstr("nothing in the motion is like the character's tail and front legs"));
  EXPECT_NE(refusalOf(person, quadrupedOnOneJoint()), "");
}

TEST(AnimalMaps, FeetOnRootsOfTheirOwnAreFeet) {
  const Skeleton one = quadruped(0.5), other = nameless(onTheGround(quadruped(0.5), kAllPaws));
  const SkeletonMap map = matchSkeletons(one, other);
  const JointMatch* foot = matchOf(map, "leftFoot");
  ASSERT_TRUE(foot);
  EXPECT_EQ(other.joints[foot->target.front()].parent, Index{0});
  EXPECT_EQ(foot->target.front(), foot->source.front() + 1);
}

// Legs that begin at a collar's tip, which hangs below the shoulder.
TEST(AnimalMaps, WhatGoesUpBeforeALegIsABlade) {
  Skeleton collared = quadruped(0.5);
  for (const std::string side : {"b1Left", "b1Right"}) collared = withJointBefore(collared, side + "One", side + "Tip");
  for (const std::string side : {"b1Left", "b1Right"}) {
    collared.joints[collared.find(side + "Tip").value()].rest.translation.y() -= 0.3;
    collared.joints[collared.find(side + "One").value()].rest.translation.y() += 0.3;
  }
  const Skeleton other = nameless(quadruped(0.5));
  const SkeletonMap map = matchSkeletons(collared, other);
  EXPECT_EQ(sourceOf(map, collared, "leftUpperLeg"), Names({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(map, collared, "rightFoot"), Names({"b1RightThree"}));
  EXPECT_EQ(RetargetSetup(collared, other, map, {}).animalLegs.size(), 4u);
}

// A joint more between elbow and wrist goes with the lower bone.
TEST(AnimalMaps, OtherNumbersOfBonesAreMatchedByWhereTheyLie) {
  const Skeleton one = quadruped(0.5), other = nameless(one);
  const Skeleton longer = withJointBefore(withJointBefore(one, "b1LeftThree", "wrist"), "b1RightThree", "otherWrist");
  const SkeletonMap fewer = matchSkeletons(longer, other), more = matchSkeletons(other, longer);
  EXPECT_EQ(sourceOf(fewer, longer, "leftUpperLeg"), Names({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(fewer, longer, "leftLowerLeg"), Names({"b1LeftTwo", "wrist"}));
  ASSERT_TRUE(matchOf(more, "rightLowerLeg") && matchOf(fewer, "rightLowerLeg"));
  EXPECT_EQ(matchOf(more, "rightLowerLeg")->target, matchOf(fewer, "rightLowerLeg")->source);
}

TEST(AnimalMaps, SpidersAreNoQuadrupeds) {
  const Skeleton animal = quadruped(0.5);
  Skeleton six = quadrupedOnOneJoint();
  EXPECT_TRUE(matchSkeletons(animal, nameless(quadruped(0.4))).isQuadruped());
  for (const std::string side : {"Left", "Right"}) {
    addJoint(six, side + "One", "body", Vec3(side == "Left" ? 0.2 : -0.2, -0.35, 0));
    addJoint(six, side + "Two", side + "One", Vec3(0, -0.45, 0.02));
    addJoint(six, side + "Three", side + "Two", Vec3(0, -0.45, -0.02));
    addJoint(six, side + "Four", side + "Three", Vec3(0, -0.04, 0.1));
  }
  const Skeleton spider = limber::testing::spider().skeleton;
  EXPECT_NE(refusalOf(animal, nameless(six)), "");
  EXPECT_NE(refusalOf(animal, spider), "");
  EXPECT_FALSE(matchSkeletons(spider, spider).isQuadruped());
}

TEST(AnimalMaps, LegsMayAllHangOnOneJointBesideTheTrunk) {
  const Skeleton one = quadrupedOnOneJoint(), other = nameless(quadruped(0.5));
  const SkeletonMap map = matchSkeletons(one, other);
  EXPECT_EQ(sourceOf(map, one, "hips"), Names({"body"}));
  EXPECT_EQ(sourceOf(map, one, "trunk"), Names({"b0", "b1"}));
  EXPECT_EQ(sourceOf(map, one, "neck"), Names({"n0"}));
  EXPECT_EQ(sourceOf(map, one, "tail"), Names({"tail1", "tail2", "tail3"}));
  EXPECT_EQ(sourceOf(map, one, "leftUpperLeg"), Names({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(map, one, "rightFoot2"), Names({"b0RightThree"}));
  const RetargetSetup setup(one, other, map, {});
  ASSERT_EQ(setup.animalLegs.size(), 4u);
  for (const AnimalLeg& leg : setup.animalLegs) {
    EXPECT_EQ(leg.fore, one.joints[leg.source.upper].name.starts_with("b1"));
  }
}

// Words that both have: not most of them, or of joints that hang elsewhere.
TEST(AnimalMaps, SomeEqualNamesAreNoFamily) {
  const auto eared = [](Skeleton animal) {
    for (const char* ear : {"leftEar", "rightEar"})
      addJoint(animal, ear, "n1", Vec3(ear[0] == 'l' ? 0.1 : -0.1, 0.1, 0));
    return animal;
  };
  const auto renamed = [&](Skeleton other, const Names& ends) {
    for (Joint& joint : other.joints) {
      for (const std::string& end : ends) {
        if (joint.name.ends_with(end)) joint.name += "x";
      }
    }
    return other;
  };
  const Skeleton one = eared(quadruped(0.5)), like = eared(quadruped(0.45));
  EXPECT_TRUE(matchSkeletons(one, renamed(like, {"Two"})).jointByJoint);
  EXPECT_FALSE(matchSkeletons(one, renamed(quadrupedOnOneJoint(), {"Two", "Four", "1", "tail3"})).jointByJoint);
  const Skeleton longer = withJointBefore(renamed(like, {"Two", "Four", "b1", "tail2", "tail3"}), "b1x", "loin");
  const SkeletonMap map = matchSkeletons(one, longer);
  EXPECT_TRUE(map.isQuadruped());
  EXPECT_EQ(followedBy(map, one, longer, "leftEar"), Names({"leftEar"}));
  EXPECT_EQ(followedBy(map, one, longer, "rightEar"), Names({"rightEar"}));
}

TEST(AnimalMaps, TheHeadIsWhatIsCalledSo) {
  const Skeleton one = withJointBefore(quadruped(0.5), "n1", "Head"), other = nameless(quadruped(0.5));
  const SkeletonMap map = matchSkeletons(one, other);
  EXPECT_EQ(sourceOf(map, one, "neck"), Names({"n0"}));
  EXPECT_EQ(sourceOf(map, one, "head"), Names({"Head"}));
}

// Where each faces is read, too.
TEST(AnimalMaps, EachMayFaceElsewhere) {
  const Skeleton one = quadruped(0.5);
  for (const double degrees : {0.0, 90.0, 200.0}) {
    SCOPED_TRACE(degrees);
    const Quat turn = limber::testing::turn(Vec3::UnitY(), degrees);
    const Skeleton turned = limber::testing::turnedAsAWhole(nameless(quadruped(0.35)), turn);
    const SkeletonMap map = matchSkeletons(one, turned);
    for (const JointMatch& match : map.matches) EXPECT_EQ(match.source, match.target) << nameOf(match, turned);
    EXPECT_LT((readAnatomy(turned).axes.front - turn * Vec3::UnitZ()).norm(), 1e-9);
  }
}

TEST(AnimalMaps, TrunkNeckAndTailGoAlongTheirChains) {
  const Skeleton one = chainedAnimal(4, 2, 3), other = chainedAnimal(2, 3, 3);
  const SkeletonMap map = matchSkeletons(one, other);
  const JointMatch *trunk = matchOf(map, "trunk"), *neck = matchOf(map, "neck");
  ASSERT_TRUE(trunk && neck);
  EXPECT_EQ(namesAt(one, trunk->source), (Names{"spine1", "spine2", "spine3", "spine4"}));
  EXPECT_EQ(namesAt(other, trunk->target), (Names{"spine1", "spine2"}));
  EXPECT_EQ(namesAt(one, neck->source), (Names{"spine5", "spine6"}));
  EXPECT_EQ(namesAt(other, neck->target), (Names{"spine3", "spine4", "spine5"}));
  for (const char* joint : {"tail1", "Head", "b1LeftOne"}) {
    EXPECT_EQ(followedBy(map, one, other, joint).front(), joint);
  }
  EXPECT_NO_THROW(checkSkeletonMap(map, one, other));
}

// By their names neck joints would go with each other: spine4 with spine4.
TEST(AnimalMaps, ChainsThatHaveAsManyGoJointByJointInFamilies) {
  const Skeleton one = chainedAnimal(3, 2, 2), other = chainedAnimal(2, 2, 5);
  const SkeletonMap map = matchSkeletons(one, other);
  EXPECT_EQ(followedBy(map, one, other, "spine3"), Names{"spine4"});
  ASSERT_TRUE(matchOf(map, "tail"));
  EXPECT_EQ(matchOf(map, "tail")->target.size(), 5u);
}

TEST(AnimalMaps, EqualBodiesGoByTheirNames) {
  const Skeleton one = chainedAnimal(3, 2, 4), other = limber::testing::scaled(one, 2);
  const SkeletonMap map = matchSkeletons(one, other);
  ASSERT_EQ(map.matches.size(), one.joints.size());
  for (const JointMatch& match : map.matches) EXPECT_EQ(match.source, match.target);
}

// The first joint of the source in the match that moves that joint.
std::string firstFollowed(const SkeletonMap& map, const Skeleton& source, const Skeleton& target,
                          const std::string& joint) {
  const Names names = followedBy(map, source, target, joint);
  return names.empty() ? "" : names.front();
}

TEST(AnimalMaps, WingsGoWithWingsAndLegsWithLegs) {
  const Skeleton gull = flyer(kGull), bat = flyer(kBat);
  const SkeletonMap map = matchSkeletons(gull, bat);
  EXPECT_NO_THROW(checkSkeletonMap(map, gull, bat));
  EXPECT_FALSE(map.isBiped());
  EXPECT_EQ(firstFollowed(map, gull, bat, "carrier"), "carrier");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Fluegel_WingL1"), "wingL1");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Fluegel_WingR3").substr(0, 5), "wingR");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Hind_legL2"), "legL2");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Hind_legR3"), "legR3");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Rumpf1"), "spine1");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Schwanz2"), "tail1");
}

TEST(AnimalMaps, FormTellsWhereNamesDoNot) {
  const Skeleton gull = flyer(kGull), other = flyer(kNamelessBird);
  const SkeletonMap map = matchSkeletons(gull, other);
  EXPECT_EQ(firstFollowed(map, gull, other, "aL1"), "wingL1");
  EXPECT_EQ(firstFollowed(map, gull, other, "bR3"), "legR3");
  EXPECT_EQ(firstFollowed(map, gull, other, "e1"), "tail1");
}

TEST(AnimalMaps, FacingElsewhereIsNoHindrance) {
  const Skeleton gull = flyer(kGull), bat = flyer(kBat, 90);
  const SkeletonMap map = matchSkeletons(gull, bat);
  EXPECT_EQ(firstFollowed(map, gull, bat, "Fluegel_WingL1"), "wingL1");
  EXPECT_EQ(firstFollowed(map, gull, bat, "Hind_legR3"), "legR3");
}

TEST(AnimalMaps, WhatIsNotAlikeIsNotMatched) {
  const Skeleton gull = flyer(kGull);
  Skeleton insect = flyer(kBat);  // two more pairs of legs
  for (const char* leg : {"two", "three"}) {
    for (const double side : {1.0, -1.0}) {
      const std::string name = std::string(leg) + (side > 0 ? "L" : "R") + "leg";
      addJoint(insect, name + "1", "Rumpf1", Vec3(0.1 * side, 0, 0));
      addJoint(insect, name + "2", name + "1", Vec3(0.3 * side, -0.4, 0));
    }
  }
  EXPECT_THAT(refusalOf(gull, insect),
              ::testing::HasSubstr("nothing in the motion is like the character's legs 1 and legs 2"));
  Skeleton two;
  addJoint(two, "one", "", Vec3::Zero());
  addJoint(two, "two", "one", Vec3(0, 1, 0));
  EXPECT_NE(refusalOf(gull, two), "");
}

// Ears that the other has none of go with the head.
TEST(AnimalMaps, WhatOneLacksIsToldWithWhatItGoesAlong) {
  const Skeleton gull = flyer(kGull);
  Skeleton horned = flyer(kBat);
  for (const double side : {1.0, -1.0})
    addJoint(horned, side > 0 ? "earL" : "earR", "The Head", Vec3(0.1 * side, 0.1, 0));
  const SkeletonMap map = matchSkeletons(gull, horned);
  std::size_t ears = 0;
  for (const UnmatchedPart& part : map.left) {
    const std::string name = part.ofTarget ? horned.joints[part.joints.front()].name : "";
    if (name != "earL" && name != "earR") continue;
    ++ears;
    EXPECT_EQ(part.carrier, body_part::kHead);
  }
  EXPECT_EQ(ears, 2u);
}

}  // namespace
}  // namespace limber
