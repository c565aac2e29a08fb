#include "limber/matching/quadruped_shape.h"

#include <string>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::addJoint;
using limber::testing::onTheGround;
using limber::testing::quadruped;
using limber::testing::quadrupedOnOneJoint;
using limber::testing::withJointBefore;

const std::vector<std::string> kPaws = {"b0LeftThree", "b0RightThree", "b1LeftThree", "b1RightThree"};

// The same in a language that nobody knows.
Skeleton nameless(Skeleton animal) {
  for (Index j = 0; j < animal.jointCount(); ++j) animal.joints[j].name = "q" + std::to_string(j);
  return animal;
}

std::vector<std::string> namesIn(const Skeleton& skeleton, const std::vector<Index>& joints) {
  std::vector<std::string> names;
  for (const Index joint : joints) names.push_back(skeleton.joints[joint].name);
  return names;
}

std::vector<std::string> sourceOf(const SkeletonMap& map, const Skeleton& source, const char* part) {
  const JointMatch* match = map.find(part);
  return match ? namesIn(source, match->source) : std::vector<std::string>();
}

using PartNames = std::vector<std::string>;

TEST(QuadrupedShape, TellsBodyAndLegs) {
  const Skeleton one = quadruped(0.5), other = nameless(quadruped(0.35));
  const std::optional<SkeletonMap> map = matchQuadrupeds(one, other);
  ASSERT_TRUE(map);
  EXPECT_EQ(sourceOf(*map, one, kHindquarters), PartNames({"b0"}));
  EXPECT_EQ(sourceOf(*map, one, "trunk"), PartNames({"b1"}));
  EXPECT_EQ(sourceOf(*map, one, "neck"), PartNames({"n0"}));
  EXPECT_EQ(sourceOf(*map, one, "head"), PartNames({"n1"}));
  EXPECT_EQ(sourceOf(*map, one, "tail"), PartNames({"tail1", "tail2", "tail3"}))
      << "though it hangs down to the ground";
  EXPECT_EQ(sourceOf(*map, one, "leftForeBone1"), PartNames({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(*map, one, "rightHindBone2"), PartNames({"b0RightTwo"}));
  EXPECT_EQ(sourceOf(*map, one, "leftHindFoot"), PartNames({"b0LeftThree"}));
  EXPECT_EQ(sourceOf(*map, one, "rightForeToes"), PartNames({"b1RightFour"}));
  for (const JointMatch& match : map->matches) EXPECT_EQ(match.source, match.target) << match.part;
  EXPECT_EQ(legEndOf("leftForeBone1"), LegEnd::kUpper);
  EXPECT_EQ(legEndOf("rightHindFoot"), LegEnd::kFoot);
  EXPECT_FALSE(legEndOf("leftForeBone2"));
}

TEST(QuadrupedShape, AnimalsAreNotTakenForPeople) {
  const Skeleton one = quadruped(0.5), other = nameless(quadruped(0.45));
  EXPECT_TRUE(matchSkeletons(one, nameless(onTheGround(other, {}))).find(kHindquarters));
  EXPECT_EQ(matchSkeletons(one, other).matches.size(), one.jointCount())
      << "joint by joint where the trees are the same";
}

TEST(QuadrupedShape, PeopleDoNotFollowThem) {
  const Skeleton animal = nameless(quadruped(0.5)), person = practiceHumanoid();
  for (const auto& [source, target] : {std::pair(animal, person), std::pair(person, animal)}) {
    try {
      matchSkeletons(source, target);
      ADD_FAILURE() << "matched";
    } catch (const Error& error) {
      EXPECT_TRUE(error.message().ends_with("one is a person, the other stands on four legs")) << error.what();
    }
  }
}

TEST(QuadrupedShape, FeetOnRootsOfTheirOwnAreFeet) {
  const Skeleton one = quadruped(0.5), other = nameless(onTheGround(quadruped(0.5), kPaws));
  const std::optional<SkeletonMap> map = matchQuadrupeds(one, other);
  ASSERT_TRUE(map);
  const JointMatch* foot = map->find("leftForeFoot");
  ASSERT_TRUE(foot);
  EXPECT_EQ(other.joints[foot->target.front()].parent, Index{0});
  EXPECT_EQ(foot->target.front(), foot->source.front() + 1);
}

// Legs that begin at a collar's tip, which hangs below the shoulder.
TEST(QuadrupedShape, WhatGoesUpBeforeALegIsABlade) {
  Skeleton collared = quadruped(0.5);
  for (const std::string side : {"b1Left", "b1Right"}) collared = withJointBefore(collared, side + "One", side + "Tip");
  for (const std::string side : {"b1Left", "b1Right"}) {
    collared.joints[collared.find(side + "Tip").value()].rest.translation.y() -= 0.3;
    collared.joints[collared.find(side + "One").value()].rest.translation.y() += 0.3;
  }
  const Skeleton other = nameless(quadruped(0.5));
  const SkeletonMap map = matchQuadrupeds(collared, other).value();
  EXPECT_EQ(sourceOf(map, collared, "leftForeBone1"), PartNames({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(map, collared, "rightForeFoot"), PartNames({"b1RightThree"}));
  EXPECT_EQ(RetargetSetup(collared, other, map, {}).animalLegs.size(), 4u);
}

// A joint more between elbow and wrist goes with the lower bone.
TEST(QuadrupedShape, OtherNumbersOfBonesAreMatchedByWhereTheyLie) {
  const Skeleton one = quadruped(0.5), other = nameless(one);
  const Skeleton longer = withJointBefore(withJointBefore(one, "b1LeftThree", "wrist"), "b1RightThree", "otherWrist");
  const SkeletonMap fewer = matchQuadrupeds(longer, other).value(), more = matchQuadrupeds(other, longer).value();
  EXPECT_EQ(sourceOf(fewer, longer, "leftForeBone1"), PartNames({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(fewer, longer, "leftForeBone2"), PartNames({"b1LeftTwo", "wrist"}));
  EXPECT_EQ(more.find("rightForeBone2")->target, fewer.find("rightForeBone2")->source);
}

TEST(QuadrupedShape, PeopleTablesAndSpidersAreNone) {
  const Skeleton animal = quadruped(0.5);
  EXPECT_FALSE(matchQuadrupeds(animal, practiceHumanoid()));
  const Skeleton beside = quadrupedOnOneJoint();
  Skeleton table, spider = beside;  // no trunk; six legs
  for (const Joint& joint : beside.joints) {
    const bool isOfLeg = joint.name.find("Left") != std::string::npos || joint.name.find("Right") != std::string::npos;
    if (joint.parent && !isOfLeg) continue;
    addJoint(table, joint.name, joint.parent ? beside.joints[*joint.parent].name : "", joint.rest.translation);
  }
  EXPECT_EQ(table.jointCount(), 17u);
  EXPECT_FALSE(matchQuadrupeds(animal, table));
  for (const std::string side : {"Left", "Right"}) {
    addJoint(spider, side + "One", "body", Vec3(side == "Left" ? 0.2 : -0.2, -0.35, 0));
    addJoint(spider, side + "Two", side + "One", Vec3(0, -0.45, 0.02));
    addJoint(spider, side + "Three", side + "Two", Vec3(0, -0.45, -0.02));
    addJoint(spider, side + "Four", side + "Three", Vec3(0, -0.04, 0.1));
  }
  EXPECT_TRUE(matchQuadrupeds(animal, beside));
  EXPECT_FALSE(matchQuadrupeds(animal, spider));
}

TEST(QuadrupedShape, LegsMayAllHangOnOneJointBesideTheTrunk) {
  const Skeleton one = quadrupedOnOneJoint(), other = nameless(quadruped(0.5));
  const SkeletonMap map = matchQuadrupeds(one, other).value();
  EXPECT_EQ(sourceOf(map, one, kHindquarters), PartNames({"body"}));
  EXPECT_EQ(sourceOf(map, one, "trunk"), PartNames({"b0", "b1"}));
  EXPECT_EQ(sourceOf(map, one, "neck"), PartNames({"n0"}));
  EXPECT_EQ(sourceOf(map, one, "tail"), PartNames({"tail1", "tail2", "tail3"}));
  EXPECT_EQ(sourceOf(map, one, "leftForeBone1"), PartNames({"b1LeftOne"}));
  EXPECT_EQ(sourceOf(map, one, "rightHindFoot"), PartNames({"b0RightThree"}));
  for (const JointMatch& match : map.matches) {
    EXPECT_EQ(isForeleg(map, match.target.front()), match.part == "leftForeBone1" || match.part == "rightForeBone1");
  }
  EXPECT_EQ(RetargetSetup(one, other, map, {}).animalLegs.size(), 4u);
}

// A body that faces elsewhere moves as it would if it did not, matched by names or by form.
TEST(QuadrupedShape, EachMovesForwardAsItSeesIt) {
  const Skeleton one = quadruped(0.5), same = quadruped(0.45), other = nameless(withJointBefore(same, "n1", "throat"));
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 20; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    pose.locals[0].translation += Vec3(0, 0.001 * f, 0.02 * f);
    for (const char* leg : {"b0LeftOne", "b1RightOne", "n0"}) {
      pose.locals[one.find(leg).value()].rotation = limber::testing::turn(-Vec3::UnitX(), 2 * f);
    }
  }
  const auto moved = [&](const Skeleton& target) {
    const RetargetSetup setup(one, target, matchSkeletons(one, target), {}, &motion);
    return poseGlobals(target, retargetFrames(findRetargetMethod("limb-ik"), setup, motion).poses.back());
  };
  for (const Skeleton& target : {same, other}) {
    for (const double degrees : {90.0, 180.0, 37.0}) {
      const Quat turn = limber::testing::turn(Vec3::UnitY(), degrees);
      Skeleton turned = target;
      Transform& root = turned.joints[0].rest;
      root = {turn * root.translation, turn * root.rotation, root.scale};
      const std::vector<Affine> there = moved(turned), here = moved(target);
      for (Index j = 0; j < target.jointCount(); ++j) {
        EXPECT_LT((there[j].translation() - turn * here[j].translation()).norm(), 1e-6) << degrees << ' ' << j;
      }
    }
  }
}

// Words that both have: not most of them, or of joints that hang elsewhere.
TEST(QuadrupedShape, SomeEqualNamesAreNoFamily) {
  Skeleton one = quadruped(0.5);
  for (const char* ear : {"leftEar", "rightEar"}) addJoint(one, ear, "n1", Vec3(ear[0] == 'l' ? 0.1 : -0.1, 0.1, 0));
  const auto renamed = [&](Skeleton other, const std::vector<std::string>& ends) {
    for (Joint& joint : other.joints) {
      for (const std::string& end : ends) {
        if (joint.name.ends_with(end)) joint.name += "x";
      }
    }
    return other;
  };
  EXPECT_FALSE(matchSkeletons(one, renamed(one, {"Two"})).find(kHindquarters));
  EXPECT_TRUE(matchSkeletons(one, renamed(quadrupedOnOneJoint(), {"Two", "Four", "1", "tail3"})).find(kHindquarters));
  const Skeleton other = renamed(one, {"Two", "Four", "b1", "tail2", "tail3"});
  const Skeleton longer = withJointBefore(other, "b1x", "loin");
  const SkeletonMap map = matchSkeletons(one, longer);
  ASSERT_TRUE(map.find(kHindquarters));
  EXPECT_EQ(sourceOf(map, one, "leftEar"), PartNames({"leftEar"})) << "what no part has goes by its name";
  EXPECT_EQ(map.find("rightEar")->target, std::vector<Index>({longer.find("rightEar").value()}));
}

TEST(QuadrupedShape, TheHeadIsWhatIsCalledSo) {
  Skeleton one = withJointBefore(quadruped(0.5), "n1", "Head");
  const Skeleton other = nameless(quadruped(0.5));
  const SkeletonMap map = matchQuadrupeds(one, other).value();
  EXPECT_EQ(sourceOf(map, one, "neck"), PartNames({"n0"}));
  EXPECT_EQ(sourceOf(map, one, "head"), PartNames({"Head"}));
}

// Bodies of differing names and legs: paws stand and rise as the source's, wherever the target's hang.
TEST(QuadrupedShape, PawsGoTheSourcesWay) {
  const Skeleton one = quadruped(0.5);
  const Index lifted = one.find("b1LeftTwo").value(), upper = one.find("b1LeftOne").value();
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 40; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    const double bend = f < 15 ? 0 : 50 * (1 - std::cos(0.25 * (f - 15)));
    pose.locals[upper].rotation = limber::testing::turn(-Vec3::UnitX(), 0.5 * bend);
    pose.locals[lifted].rotation = limber::testing::turn(Vec3::UnitX(), bend);
  }
  for (const Skeleton& other : {nameless(withJointBefore(limber::testing::scaled(quadruped(0.45), 2), "n1", "throat")),
                                nameless(onTheGround(limber::testing::scaled(quadruped(0.45), 2), kPaws))}) {
    const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
    ASSERT_TRUE(setup.map.find(kHindquarters));
    ASSERT_EQ(setup.animalLegs.size(), 4u);
    for (const char* method : {"limb-ik", "online", "spacetime"}) {
      SCOPED_TRACE(method);
      const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
      for (std::size_t f = 5; f < 40; ++f) {
        const std::vector<Affine> from = poseGlobals(one, motion.poses[f]), to = poseGlobals(other, result.poses[f]);
        for (const AnimalLeg& leg : setup.animalLegs) {
          const Vec3 way = from[leg.source.end].translation() - restGlobals(one)[leg.source.end].translation();
          const Vec3 went = to[leg.target.end].translation() - restGlobals(other)[leg.target.end].translation();
          EXPECT_LT((went - setup.scale * way).norm(), leg.source.lower == lifted ? 0.2 : 0.03) << f;
        }
      }
    }
  }
}

// How far the forepaws are from below their hips, of a body whose trunk is so many times as long and that has turned
// about its hind legs.
double forepawsAside(double trunk) {
  const Skeleton one = quadruped(0.5);
  Skeleton other = withJointBefore(quadruped(0.5), "n1", "throat");
  other.joints[other.find("b1").value()].rest.translation *= trunk;
  other = nameless(other);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 40; ++f) {
    Pose& pose = motion.poses.emplace_back(restPose(one));
    pose.locals[0].rotation = limber::testing::turn(Vec3::UnitY(), 1.5 * f);
    for (const char* paw : {"b1LeftOne", "b1RightOne"}) {  // steps all the while
      pose.locals[one.find(paw).value()].rotation = limber::testing::turn(Vec3::UnitX(), 10 * std::sin(0.9 * f));
    }
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {}, &motion);
  const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, motion);
  const std::vector<Affine> globals = poseGlobals(other, result.poses.back());
  const AnimalLeg& fore = setup.animalLegs.back();
  const Vec3 aside = globals[fore.target.end].translation() - globals[fore.target.upper].translation();
  return std::hypot(aside.x(), aside.z());
}

TEST(QuadrupedShape, LongerTrunksTakeTheirForepawsAlong) {
  EXPECT_LT(forepawsAside(2), forepawsAside(1) + 0.3);
}

// One whose legs begin far below its trunk lies on the ground as the source does, not in it.
TEST(QuadrupedShape, BodiesLieOnTheGround) {
  const Skeleton one = quadruped(0.5);
  Skeleton deep = withJointBefore(one, "n1", "throat");
  for (Joint& joint : deep.joints) {
    if (joint.name.ends_with("One")) joint.rest.translation.y() = -0.35;
    if (joint.name.ends_with("Two")) joint.rest.translation.y() += 0.3;
  }
  const Skeleton other = nameless(deep);
  PoseSequence motion{{}, 1.0 / 30};
  for (int f = 0; f < 30; ++f) {
    motion.poses.push_back(restPose(one));
    motion.poses.back().locals[0].translation.y() -= 0.03 * f;
  }
  const RetargetSetup setup(one, other, matchSkeletons(one, other), {});
  ASSERT_TRUE(setup.map.find(kHindquarters));
  for (const char* method : {"limb-ik", "online", "spacetime"}) {
    const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, motion);
    const std::vector<Affine> lies = poseGlobals(other, result.poses.back());
    for (const AnimalLeg& leg : setup.animalLegs) {
      EXPECT_GT(lies[leg.target.upper].translation().y(), setup.targetGround - 0.03) << method;
    }
  }
}

}  // namespace
}  // namespace limber
