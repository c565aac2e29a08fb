#include "limber/character/matching/skeleton_map.h"

#include <gmock/gmock.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"

namespace limber {
namespace {

using limber::testing::followedBy;
using limber::testing::matchOf;
using limber::testing::renamed;
using limber::testing::withJointBefore;

std::vector<std::string> namesOf(const Skeleton& skeleton, const std::vector<Index>& joints) {
  std::vector<std::string> names;
  for (const Index joint : joints) names.push_back(skeleton.joints[joint].name);
  return names;
}

TEST(SkeletonMap, PeopleByName) {
  const Skeleton a = practiceHumanoid(), b = renamed(a);
  const SkeletonMap map = matchSkeletons(a, b);
  EXPECT_EQ(namesOf(b, matchOf(map, "leftFoot")->target), std::vector<std::string>{"foot_l"});
  EXPECT_EQ(namesOf(b, matchOf(map, "trunk")->target), (std::vector<std::string>{"spine_01", "spine_02", "spine_03"}));
  EXPECT_EQ(matchOf(map, "leftThumbDistal")->source, matchOf(map, "leftThumbDistal")->target);
  checkSkeletonMap(map, a, b);
}

TEST(SkeletonMap, LinksGoWithTheirLimb) {
  const Skeleton a = practiceHumanoid(), b = withJointBefore(a, "leftLowerArm", "half");
  const SkeletonMap map = matchSkeletons(a, b);
  EXPECT_EQ(namesOf(b, matchOf(map, "leftUpperArm")->target), (std::vector<std::string>{"leftUpperArm", "half"}));
  EXPECT_EQ(matchOf(map, "leftUpperArm")->source.size(), 1U);
}

TEST(SkeletonMap, NumberedPeopleByShape) {
  const Skeleton a = practiceHumanoid();
  Skeleton b = a;
  for (Index j = 0; j < b.jointCount(); ++j) b.joints[j].name = "joint" + std::to_string(j);
  const SkeletonMap map = matchSkeletons(a, b);
  for (const char* bone : {"hips", "head", "leftUpperArm", "leftLowerArm", "leftHand", "rightUpperArm", "rightHand",
                           "leftUpperLeg", "leftLowerLeg", "leftFoot", "rightFoot", "rightLowerLeg"}) {
    ASSERT_TRUE(matchOf(map, bone)) << bone;
    EXPECT_EQ(matchOf(map, bone)->target.front(), a.find(bone)) << bone;
    EXPECT_GE(matchOf(map, bone)->confidence, kDoubtful) << bone;
    EXPECT_EQ(matchOf(map, bone)->by, MatchedBy::kShape);
  }
}

TEST(SkeletonMap, DeclaredBonesAreWithoutDoubtWhicheverWayTheyFace) {
  const Skeleton a = limber::testing::personWith(limber::testing::NameHabit::kCmu).skeleton;
  const Skeleton b = limber::testing::turnedAsAWhole(limber::testing::declaredPerson(), Quat(0, 0, 1, 0));
  const SkeletonMap map = matchSkeletons(a, b);
  for (const Joint& joint : b.joints) {
    const std::string bone(joint.declaredBone);
    const bool isLimb = bone.starts_with("left") || bone.starts_with("right");
    if (!isLimb && bone != "hips" && bone != "head") continue;
    ASSERT_TRUE(matchOf(map, bone)) << bone;
    EXPECT_EQ(namesOf(b, matchOf(map, bone)->target), std::vector<std::string>{joint.name});
    EXPECT_GE(matchOf(map, bone)->confidence, kDoubtful) << bone;
  }
}

TEST(SkeletonMap, FamiliesByEqualNames) {
  Skeleton snake;
  for (int i = 0; i < 9; ++i) {
    Joint joint;
    joint.name = "Tail" + std::to_string(i);
    if (i > 0) joint.parent = static_cast<Index>(i - 1);
    joint.rest.translation = Vec3(0, 0, -0.2);
    snake.joints.push_back(joint);
  }
  Skeleton other = snake;
  for (Joint& joint : other.joints) joint.name = "rig:tail_" + joint.name.substr(4);
  EXPECT_EQ(matchSkeletons(snake, other).matches.size(), 9U);
  other.joints.resize(5);
  for (Joint& joint : other.joints) joint.name.replace(0, 9, "x");
  try {  // a shorter one under other names is none: if it goes with the first, then along its spine
    const SkeletonMap map = matchSkeletons(snake, other);
    EXPECT_FALSE(map.jointByJoint);
    for (const JointMatch& match : map.matches) EXPECT_EQ(match.by, MatchedBy::kShape);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
  }
}

// Hips with legs, a tail and what is given besides.
Skeleton person(const std::vector<std::pair<std::string, std::string>>& others) {
  Skeleton made = practiceHumanoid();
  for (const auto& [name, parent] : others) limber::testing::addJoint(made, name, parent, Vec3(0, 0, -0.2));
  return made;
}

TEST(SkeletonMap, WhatPeopleHaveBesidesGoesByItsName) {
  const Skeleton a = person({{"Tail1", "hips"}, {"Tail2", "Tail1"}, {"pocket", "hips"}, {"Wing", "chest"}});
  const Skeleton b = person({{"pocket", "leftHand"}, {"Tail1", "hips"}, {"Tail2", "Tail1"}, {"Horn", "head"}});
  const SkeletonMap map = matchSkeletons(a, b);
  for (const char* joint : {"Tail1", "Tail2"}) {
    EXPECT_THAT(followedBy(map, a, b, joint), ::testing::Contains(joint));
  }
  for (const char* joint : {"pocket", "Horn"}) EXPECT_TRUE(followedBy(map, a, b, joint).empty()) << joint;
  for (const JointMatch& match : map.matches)
    EXPECT_THAT(namesOf(a, match.source), ::testing::Not(::testing::Contains("Wing")));
  checkSkeletonMap(map, a, b);
}

// Legs alone make no person of a bird, whose wings would stay where they are.
TEST(SkeletonMap, AFamilyWithoutArmsGoesByItsNames) {
  Skeleton bird;
  const auto add = [&](const char* name, const char* parent, const Vec3& offset) {
    limber::testing::addJoint(bird, name, parent, offset);
  };
  bird.joints.push_back({"hips", std::nullopt, {}, 0});
  add("spine", "hips", Vec3(0, 0.1, 0.3));
  add("head", "spine", Vec3(0, 0.2, 0.1));
  for (const std::string side : {"L", "R"}) {
    const double x = side == "L" ? 1 : -1;
    add(("UpperLeg_" + side).c_str(), "hips", Vec3(0.1 * x, 0, 0));
    add(("LowerLeg_" + side).c_str(), ("UpperLeg_" + side).c_str(), Vec3(0, -0.2, 0.1));
    add(("Foot_" + side).c_str(), ("LowerLeg_" + side).c_str(), Vec3(0, -0.2, -0.1));
    add(("wing_" + side).c_str(), "spine", Vec3(0.2 * x, 0, 0));
  }
  EXPECT_EQ(matchSkeletons(bird, bird).matches.size(), bird.jointCount());
}

TEST(SkeletonMap, AFileSaysItAll) {
  const Skeleton a = practiceHumanoid(), b = renamed(a);
  const SkeletonMap map = matchSkeletons(a, b);
  const std::string text = skeletonMapToJson(map, a, b);
  const SkeletonMap read = skeletonMapFromJson(text, a, b);
  ASSERT_EQ(read.matches.size(), map.matches.size());
  for (std::size_t i = 0; i < map.matches.size(); ++i) {
    EXPECT_EQ(read.matches[i].part, map.matches[i].part);
    EXPECT_EQ(read.matches[i].source, map.matches[i].source);
    EXPECT_EQ(read.matches[i].target, map.matches[i].target);
    EXPECT_EQ(read.matches[i].by, MatchedBy::kFile);
  }
}

TEST(SkeletonMap, BadFilesAreRefused) {
  const Skeleton a = practiceHumanoid();
  for (const char* text : {"", "{}", "[]", "{\"matches\": 3}", "{\"matches\": []}", "{\"matches\": [4]}",
                           R"({"matches": [{"part": "hips", "source": ["hips"]}]})",
                           R"({"matches": [{"part": "hips", "source": ["hips"], "target": ["nobody"]}]})",
                           R"({"matches": [{"part": "hips", "source": ["hips"], "target": []}]})",
                           R"({"matches": [{"part": "hips", "source": ["hips"], "target": [7]}]})",
                           R"({"matches": [{"part": "a", "source": ["hips"], "target": ["hips"]},
                        {"part": "b", "source": ["hips"], "target": ["hips"]}]})"}) {
    EXPECT_THROW(skeletonMapFromJson(text, a, a), Error) << text;
  }
}

// Handles of a penguin: by its form, one of them begins the right arm and the neck.
TEST(SkeletonMap, EachJointHasOnePart) {
  const struct {
    int parent;
    Vec3 offset;
  } joints[] = {
      {-1, {0.20, -0.25, 0}},     {0, {-0.12, 0.66, 0.18}},  {0, {-0.46, -0.69, 0.02}},   {0, {-0.43, 0.09, -0.02}},
      {0, {0.26, -0.73, 0.10}},   {1, {-0.01, 0.23, -0.21}}, {1, {0.48, 0, -0.21}},       {2, {0.16, -0.38, -0.03}},
      {2, {0.06, -0.11, -0.40}},  {3, {-0.32, 0.47, 0.02}},  {4, {-0.22, -0.33, -0.10}},  {5, {-0.01, 0.34, 0.02}},
      {5, {-0.13, -0.27, -0.25}}, {6, {0.21, -0.41, 0.05}},  {7, {-0.14, -0.17, -0.07}},  {8, {0.43, -0.04, -0.06}},
      {9, {-0.24, -0.85, -0.02}}, {10, {-0, -0.16, 0.28}},   {10, {0.17, -0.19, -0.09}},  {11, {-0.19, -0.10, 0.30}},
      {13, {0.07, -0.61, -0.07}}, {14, {0.13, 0.02, 0.45}},  {15, {-0.19, -0.17, -0.30}}, {17, {0.23, 0.01, 0.25}},
      {21, {-0.43, 0, -0.04}},    {23, {0.25, -0, -0.21}}};
  Skeleton penguin;
  for (const auto& [parent, offset] : joints) {
    Transform rest;
    rest.translation = offset;
    const std::string name = std::string("handle_").append(std::to_string(penguin.jointCount()));
    penguin.joints.push_back({name, parent < 0 ? std::nullopt : std::optional(static_cast<Index>(parent)), rest, 0});
  }
  const Skeleton person = practiceHumanoid();
  // Handles show no body for sure: what is matched has to be whole, or nothing is.
  for (const bool onto : {true, false}) {
    const Skeleton &from = onto ? person : penguin, &to = onto ? penguin : person;
    try {
      checkSkeletonMap(matchSkeletons(from, to), from, to);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUnsupported) << error.message();
    }
  }
}

TEST(SkeletonMap, AnimalsAreNoPeople) {
  Skeleton table;  // four legs, no arms, no head
  for (int i = 0; i < 9; ++i) {
    Joint joint;
    joint.name = std::string("j").append(std::to_string(i));
    if (i > 0) joint.parent = i % 2 == 1 ? 0 : static_cast<Index>(i - 1);
    joint.rest.translation = i == 0 ? Vec3(0, 1, 0) : Vec3(i < 5 ? 0.3 : -0.3, -0.5, i % 4 < 2 ? 0.3 : -0.3);
    table.joints.push_back(joint);
  }
  EXPECT_THROW(matchSkeletons(practiceHumanoid(), table), Error);
}

}  // namespace
}  // namespace limber
