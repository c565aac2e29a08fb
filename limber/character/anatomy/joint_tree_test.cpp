#include "limber/character/anatomy/joint_tree.h"

#include <gmock/gmock.h>

#include <string>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/error.h"

namespace limber {
namespace {

using limber::testing::onTheGround;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Parents = std::vector<std::optional<Index>>;

// 0 with 1 and 4; 1 with 2 and 3; 5 a root of its own.
JointTree smallTree() {
  return JointTree(Parents{std::nullopt, 0u, 1u, 1u, 0u, std::nullopt});
}

TEST(JointTree, TellsParentsChildrenAndRoots) {
  const JointTree tree = smallTree();
  EXPECT_EQ(tree.size(), 6u);
  EXPECT_THAT(tree.roots(), ElementsAre(0u, 5u));
  EXPECT_THAT(tree.children(0), ElementsAre(1u, 4u));
  EXPECT_THAT(tree.children(2), IsEmpty());
  EXPECT_EQ(tree.parent(3), Index{1});
  EXPECT_FALSE(tree.parent(5));
  EXPECT_EQ(tree.depth(0), 0u);
  EXPECT_EQ(tree.depth(3), 2u);
}

TEST(JointTree, ParentsComeFirstAndWhatHangsOnAJointFollowsIt) {
  const JointTree tree = smallTree();
  EXPECT_THAT(tree.order(), ElementsAre(0u, 1u, 2u, 3u, 4u, 5u));
  EXPECT_THAT(tree.subtree(1), ElementsAre(1u, 2u, 3u));
  EXPECT_THAT(tree.subtree(5), ElementsAre(5u));
  EXPECT_TRUE(tree.isAboveOrSelf(0, 3));
  EXPECT_TRUE(tree.isAboveOrSelf(3, 3));
  EXPECT_FALSE(tree.isAboveOrSelf(3, 1));
  EXPECT_FALSE(tree.isAboveOrSelf(0, 5));
}

TEST(JointTree, AParentMayComeBehindItsChild) {
  const JointTree tree(Parents{2u, 0u, std::nullopt});
  EXPECT_THAT(tree.order(), ElementsAre(2u, 0u, 1u));
  EXPECT_THAT(tree.pathBelow(2, 1), ElementsAre(0u, 1u));
}

TEST(JointTree, JointsMeetWhereBothHang) {
  const JointTree tree = smallTree();
  EXPECT_EQ(tree.meeting(2, 3), Index{1});
  EXPECT_EQ(tree.meeting(2, 4), Index{0});
  EXPECT_EQ(tree.meeting(1, 3), Index{1});
  EXPECT_EQ(tree.meeting(3, 3), Index{3});
  EXPECT_FALSE(tree.meeting(3, 5));
}

TEST(JointTree, PathsLeadDown) {
  const JointTree tree = smallTree();
  EXPECT_THAT(tree.pathBelow(0, 3), ElementsAre(1u, 3u));
  EXPECT_THAT(tree.pathBelow(3, 3), IsEmpty());
  EXPECT_THAT(tree.pathBelow(4, 3), IsEmpty());
  EXPECT_THAT(tree.pathBelow(5, 3), IsEmpty());
}

TEST(JointTree, CyclesAndMissingParentsAreRefused) {
  const auto refusal = [](Parents parents) -> std::string {
    try {
      const JointTree tree(std::move(parents));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadData);
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal({std::nullopt, 2u, 3u, 1u}), ::testing::HasSubstr("joint 1 "));
  EXPECT_THAT(refusal({0u}), ::testing::HasSubstr("joint 0 "));
  EXPECT_THAT(refusal({std::nullopt, 7u}), ::testing::HasSubstr("joint 1 hangs on joint 7"));
  EXPECT_EQ(refusal({}), "");
}

TEST(JointTree, DeepTreesAreWalked) {
  constexpr Index kDeep = 8000;
  Parents parents(kDeep);
  for (Index j = 1; j < kDeep; ++j) parents[j] = j - 1;
  const JointTree tree(parents);
  EXPECT_EQ(tree.depth(kDeep - 1), kDeep - 1);
  EXPECT_EQ(tree.subtree(0).size(), kDeep);
  EXPECT_EQ(tree.meeting(kDeep - 1, kDeep / 2), kDeep / 2);
  EXPECT_EQ(tree.pathBelow(0, kDeep - 1).size(), kDeep - 1);
  for (Index j = 0; j < kDeep; ++j) EXPECT_TRUE(tree.isAboveOrSelf(j / 2, j));
}

// With loose feet joined.
Parents joined(const Skeleton& skeleton) {
  const JointTree tree = withLooseFeetJoined(skeleton, restPositions(skeleton), Vec3::UnitY());
  Parents parents;
  for (Index j = 0; j < tree.size(); ++j) parents.push_back(tree.parent(j));
  return parents;
}

TEST(LooseFeet, FeetAtTheRootHangOnTheShinsAboveThem) {
  const Skeleton person = onTheGround(limber::testing::vrmPerson(), {"leftFoot", "rightFoot"});
  const Parents parents = joined(person);
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
    const Parents parents = joined(animal);
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
  const Skeleton person = onTheGround(limber::testing::vrmPerson(), {"leftUpperLeg", "rightUpperLeg"});
  const Parents parents = joined(person);
  EXPECT_EQ(parents[person.find("leftUpperLeg").value()], person.find("hips"));
  EXPECT_EQ(parents[person.find("rightUpperLeg").value()], person.find("hips"));
  EXPECT_EQ(parents[person.find("hips").value()], person.find("ground"));
}

TEST(LooseFeet, OthersStayAsTheyAre) {
  for (const Skeleton& skeleton : {limber::testing::vrmPerson(), limber::testing::quadruped(0.5)}) {
    const Parents parents = joined(skeleton);
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
  const Parents parents = joined(skeleton);
  for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_EQ(parents[j], skeleton.joints[j].parent);
}

// 8000 joints on the ground, each on a root of its own: no foot.
TEST(LooseFeet, ManyRootsStayLoose) {
  Skeleton skeleton;
  for (int i = 0; i < 8000; ++i) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = "j" + std::to_string(i);
    joint.rest.translation = Vec3(0.01 * i, 0, 0);
  }
  skeleton.joints[0].rest.translation.y() = 1;
  EXPECT_EQ(joined(skeleton), Parents(8000));
}

}  // namespace
}  // namespace limber
