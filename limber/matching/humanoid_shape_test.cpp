#include "limber/matching/humanoid_shape.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::inRestPose;
using limber::testing::turn;
using limber::testing::withJointBefore;

std::map<std::string, HumanoidJoint> byBone(const Skeleton& skeleton) {
  std::map<std::string, HumanoidJoint> joints;
  for (const HumanoidJoint& joint : humanoidJointsByShape(skeleton)) joints[std::string(joint.bone)] = joint;
  return joints;
}

// Names of joints are not looked at: those of the practice humanoid say what is right.
void expectRight(const Skeleton& skeleton) {
  for (const auto& [bone, joint] : byBone(skeleton)) {
    const std::string& name = skeleton.joints[joint.joint].name;
    EXPECT_TRUE(name == bone || bone == "spine" || bone == "chest" || bone == "upperChest") << bone << ' ' << name;
  }
}

Skeleton withoutToes(const Skeleton& skeleton) {
  Skeleton shorter = skeleton;
  std::erase_if(shorter.joints, [](const Joint& joint) { return joint.name.ends_with("Toes"); });
  for (Joint& joint : shorter.joints) {
    if (joint.parent) joint.parent = shorter.find(skeleton.joints[*joint.parent].name);
  }
  return shorter;
}

TEST(HumanoidShape, FindsThePartsOfAPerson) {
  const Skeleton person = practiceHumanoid();
  EXPECT_GE(byBone(person).size(), 17u);
  expectRight(person);
}

TEST(HumanoidShape, HalfWayJointsDoNotMislead) {
  Skeleton person = practiceHumanoid();
  for (const char* end : {"leftLowerArm", "rightLowerArm", "leftLowerLeg", "rightLowerLeg", "leftHand", "rightHand"}) {
    person = withJointBefore(person, end, std::string("twist_") + end);
  }
  expectRight(person);
}

TEST(HumanoidShape, BentKneesTellTheFront) {
  Skeleton person = withoutToes(practiceHumanoid());
  for (const char* side : {"left", "right"}) {
    const std::string name(side);
    person = inRestPose(person,
                        {{name + "UpperLeg", turn(-Vec3::UnitX(), 20)}, {name + "LowerLeg", turn(Vec3::UnitX(), 40)}});
  }
  expectRight(person);
  for (Joint& joint : person.joints) {  // the same person seen from behind
    if (!joint.parent) joint.rest.rotation = turn(Vec3::UnitY(), 180);
  }
  expectRight(person);
}

// As of a dinosaur without toes.
TEST(HumanoidShape, AHeadFarAheadTellsTheFrontWhereHocksBendBackward) {
  Skeleton leaning = inRestPose(withoutToes(practiceHumanoid()), {{"spine", turn(Vec3::UnitX(), 80)}});
  for (const char* side : {"left", "right"}) {
    const std::string name(side);
    leaning = inRestPose(leaning,
                         {{name + "UpperLeg", turn(Vec3::UnitX(), 20)}, {name + "LowerLeg", turn(-Vec3::UnitX(), 40)}});
  }
  const std::map<std::string, HumanoidJoint> joints = byBone(leaning);
  ASSERT_TRUE(joints.contains("leftLowerLeg"));
  EXPECT_EQ(leaning.joints[joints.at("leftLowerLeg").joint].name, "leftLowerLeg");
}

TEST(HumanoidShape, ATrunkThatLeansMayHangBesideArmsAndLegs) {
  Skeleton person = inRestPose(practiceHumanoid(), {{"spine", turn(Vec3::UnitX(), 80)}});
  const std::vector<Affine> globals = restGlobals(person);
  const Index hips = person.find("hips").value();
  for (const char* shoulder : {"leftShoulder", "rightShoulder"}) {
    const Index joint = person.find(shoulder).value();
    person.joints[joint].parent = hips;
    person.joints[joint].rest.translation = globals[joint].translation() - globals[hips].translation();
  }
  expectRight(person);
  const std::map<std::string, HumanoidJoint> joints = byBone(person);
  for (const char* bone : {"spine", "chest", "neck", "head"}) EXPECT_TRUE(joints.contains(bone)) << bone;
}

}  // namespace
}  // namespace limber
