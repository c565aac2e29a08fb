#include "limber/matching/loose_feet.h"

#include <gtest/gtest.h>

#include "limber/matching/humanoid_shape.h"
#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::onTheGround;

std::vector<std::optional<Index>> joined(const Skeleton& skeleton) {
  std::vector<Vec3> positions;
  for (const Affine& global : restGlobals(skeleton)) positions.push_back(global.translation());
  return parentsWithLegsJoined(skeleton, positions);
}

TEST(LooseFeet, FeetAtTheRootHangOnTheShinsAboveThem) {
  const Skeleton person = onTheGround(practiceHumanoid(), {"leftFoot", "rightFoot"});
  const std::vector<std::optional<Index>> parents = joined(person);
  for (Index j = 0; j < person.jointCount(); ++j) {
    const std::string& name = person.joints[j].name;
    const bool isFoot = name == "leftFoot" || name == "rightFoot";
    EXPECT_EQ(parents[j], isFoot ? person.find(name.substr(0, name.size() - 4) + "LowerLeg") : person.joints[j].parent);
  }
}

TEST(LooseFeet, FourFeetOnRootsOfTheirOwnDoSo) {
  const std::vector<std::string> legs = {"b0Left", "b0Right", "b1Left", "b1Right"};
  std::vector<std::string> feet;
  for (const std::string& leg : legs) feet.push_back(leg + "Three");
  Skeleton animal = onTheGround(limber::testing::quadruped(0.5), feet);
  for (const bool rootless : {false, true}) {
    if (rootless) {
      for (const std::string& foot : feet) animal.joints[animal.find(foot).value()].parent.reset();
    }
    const std::vector<std::optional<Index>> parents = joined(animal);
    for (Index j = 0; j < animal.jointCount(); ++j) {
      const std::string& name = animal.joints[j].name;
      EXPECT_EQ(parents[j], name.ends_with("Three") ? animal.find(name.substr(0, name.size() - 5) + "Two")
                                                    : animal.joints[j].parent);
    }
  }
}

// Of a triceratops' proportions: shins that come down at a slant.
TEST(LooseFeet, ShinsMayLean) {
  Skeleton animal = onTheGround(limber::testing::quadruped(0.5), {"b0LeftThree", "b0RightThree"});
  for (const char* foot : {"b0LeftThree", "b0RightThree"}) {
    animal.joints[animal.find(foot).value()].rest.translation.z() -= 0.2;
  }
  EXPECT_EQ(joined(animal)[animal.find("b0LeftThree").value()], animal.find("b0LeftTwo"));
}

TEST(LooseFeet, LegsAtTheRootHangOnTheTrunkBesideThem) {
  const Skeleton person = onTheGround(practiceHumanoid(), {"leftUpperLeg", "rightUpperLeg"});
  const std::vector<std::optional<Index>> parents = joined(person);
  EXPECT_EQ(parents[person.find("leftUpperLeg").value()], person.find("hips"));
  EXPECT_EQ(parents[person.find("rightUpperLeg").value()], person.find("hips"));
  EXPECT_EQ(parents[person.find("hips").value()], person.find("ground"));
}

TEST(LooseFeet, OthersStayAsTheyAre) {
  for (const Skeleton& skeleton : {practiceHumanoid(), limber::testing::quadruped(0.5)}) {
    const std::vector<std::optional<Index>> parents = joined(skeleton);
    for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_EQ(parents[j], skeleton.joints[j].parent);
  }
}

// An animal that lies on its side has legs on a low joint with nothing else.
TEST(LooseFeet, NoLegHangsOnItself) {
  Skeleton skeleton;
  limber::testing::addJoint(skeleton, "high", "", Vec3(0, 1, 0));
  limber::testing::addJoint(skeleton, "low", "high", Vec3(0, -0.9, 0));
  for (const double side : {1.0, -1.0}) {
    const std::string leg = side > 0 ? "left" : "right";
    limber::testing::addJoint(skeleton, leg, "low", Vec3(0.2 * side, 0.2, 0));
    limber::testing::addJoint(skeleton, leg + "End", leg, Vec3(0, -0.3, 0));
  }
  const std::vector<std::optional<Index>> parents = joined(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_EQ(parents[j], skeleton.joints[j].parent);
}

// Names of joints are not looked at.
TEST(LooseFeet, APersonOnThemIsToldByForm) {
  for (const char* loose : {"Foot", "UpperLeg"}) {
    const Skeleton person =
        onTheGround(practiceHumanoid(), {std::string("left") + loose, std::string("right") + loose});
    int right = 0;
    for (const HumanoidJoint& joint : humanoidJointsByShape(person)) {
      if (joint.bone.ends_with("Foot") || joint.bone.ends_with("Leg"))
        right += person.joints[joint.joint].name == joint.bone;
    }
    EXPECT_EQ(right, 6) << loose;
  }
}

}  // namespace
}  // namespace limber
