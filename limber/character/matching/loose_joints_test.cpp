#include "limber/character/matching/loose_joints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::onTheGround;

std::vector<LooseJoint> looseOf(const Skeleton& skeleton) {
  return looseJoints(skeleton, matchSkeletons(practiceHumanoid(), skeleton), MapSide::kTarget, restPositions(skeleton));
}

// A joint on the ground's root, beside another joint.
Skeleton withLoose(Skeleton skeleton, const char* beside, const Vec3& offset) {
  Joint joint;
  joint.name = "claw";
  joint.parent = 0;
  joint.rest.translation = restGlobals(skeleton)[skeleton.find(beside).value()].translation() + offset;
  skeleton.joints.push_back(joint);
  return skeleton;
}

TEST(LooseJoints, WhatHangsOnTheHipsIsNotLoose) {
  EXPECT_TRUE(looseOf(practiceHumanoid()).empty());
  EXPECT_TRUE(looseOf(onTheGround(practiceHumanoid(), {})).empty());
}

TEST(LooseJoints, AMatchedPartRidesOnThePartAbove) {
  const Skeleton person = onTheGround(practiceHumanoid(), {"leftFoot"});
  const std::vector<LooseJoint> loose = looseOf(person);
  ASSERT_EQ(loose.size(), 2u) << "the foot, and its toes on it";
  EXPECT_EQ(loose[0].joint, person.find("leftFoot"));
  EXPECT_EQ(loose[0].carrier, person.find("leftLowerLeg"));
  EXPECT_TRUE(loose[0].matched);
  EXPECT_EQ(loose[1].carrier, person.find("leftFoot"));
}

TEST(LooseJoints, OthersRideOnWhatIsNearest) {
  const Skeleton person = onTheGround(practiceHumanoid(), {});
  const Skeleton near = withLoose(person, "leftToes", Vec3(0.01, 0, 0.02));
  const std::vector<LooseJoint> loose = looseOf(near);
  ASSERT_EQ(loose.size(), 1u);
  EXPECT_EQ(loose[0].joint, near.find("claw"));
  EXPECT_EQ(loose[0].carrier, near.find("leftToes"));
  EXPECT_FALSE(loose[0].matched);
  EXPECT_TRUE(looseOf(withLoose(person, "leftLowerLeg", Vec3(0, 0, 1))).empty()) << "what a knee points to";
}

// What Unreal's mannequin has beside its body: below roots of their own, at other joints' positions.
Skeleton withControls(Skeleton skeleton) {
  const auto at = [&](const char* joint) -> Vec3 {
    return restGlobals(skeleton)[skeleton.find(joint).value()].translation();
  };
  const auto add = [&](const char* name, const char* parent, const Vec3& position) {
    limber::testing::addJoint(skeleton, name, parent, position - at(parent));
  };
  const Vec3 ground = at("ground");
  add("ik_hand_root", "ground", ground);
  add("ik_hand_gun", "ik_hand_root", at("rightHand"));
  add("ik_hand_l", "ik_hand_gun", at("leftHand"));
  add("ik_foot_root", "ground", ground);
  add("ik_foot_l", "ik_foot_root", at("leftFoot"));
  add("ik_foot_r", "ik_foot_root", at("rightFoot"));
  return skeleton;
}

TEST(LooseJoints, AControlRidesOnTheJointThatItRestsOn) {
  // The ground's joint lies between the toes, near enough to both.
  Skeleton narrow = onTheGround(practiceHumanoid(), {});
  for (const char* side : {"left", "right"})
    narrow.joints[narrow.find(std::string(side) + "UpperLeg").value()].rest.translation.x() *= 0.5;
  const Skeleton person = withControls(narrow);
  std::map<std::string, std::string> carriers;
  for (const LooseJoint& loose : looseOf(person)) {
    EXPECT_FALSE(loose.matched);
    carriers[person.joints[loose.joint].name] = person.joints[loose.carrier].name;
  }
  const std::map<std::string, std::string> expected = {
      {"ik_hand_gun", "rightHand"}, {"ik_hand_l", "leftHand"}, {"ik_foot_l", "leftFoot"}, {"ik_foot_r", "rightFoot"}};
  EXPECT_EQ(carriers, expected) << "and what rests on the root stays with it";
}

TEST(LooseJoints, OfSeveralJointsInOnePositionTheMatchedOneCarries) {
  Skeleton person = onTheGround(practiceHumanoid(), {});
  const Index hand = person.find("leftHand").value();
  Joint twist = person.joints[hand];
  twist.name = "leftLowerArm_twist";
  person.joints.push_back(twist);
  person = withControls(person);
  const std::vector<LooseJoint> loose = looseOf(person);
  const auto control = std::find_if(loose.begin(), loose.end(), [&](const LooseJoint& each) {
    return person.joints[each.joint].name == "ik_hand_l";
  });
  ASSERT_NE(control, loose.end());
  EXPECT_EQ(control->carrier, hand);
}

}  // namespace
}  // namespace limber
