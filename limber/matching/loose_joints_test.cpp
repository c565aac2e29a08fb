#include "limber/matching/loose_joints.h"

#include <gtest/gtest.h>

#include "limber/matching/testing/test_motion.h"

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

}  // namespace
}  // namespace limber
