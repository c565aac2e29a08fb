#include "limber/character/anatomy/names/humanoid_joints.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "limber/character/anatomy/testing/bodies.h"

namespace limber {
namespace {

using namespace limber::testing;

std::map<std::string, std::string> jointsByBone(const Skeleton& skeleton) {
  std::map<std::string, std::string> bones;
  for (const HumanoidJoint& joint : humanoidJoints(skeleton)) {
    bones[std::string(joint.bone)] = skeleton.joints[joint.joint].name;
  }
  return bones;
}

TEST(HumanoidJoints, DeclaredOnesAreAsTheFileSays) {
  Skeleton person = declaredPerson();
  for (const HumanoidJoint& joint : humanoidJoints(person)) {
    EXPECT_EQ(joint.bone, person.joints[joint.joint].declaredBone);
    EXPECT_EQ(joint.confidence, 1);
  }
  EXPECT_EQ(humanoidJoints(person).size(), person.joints.size());
  // A spine of one bone has no more than that, and what is not declared is read.
  for (Joint& joint : person.joints) {
    for (const char* bone : {"chest", "upperChest", "leftHand"}) {
      if (joint.declaredBone == bone) joint.declaredBone = {};
    }
  }
  const auto bones = jointsByBone(person);
  EXPECT_EQ(bones.count("chest") + bones.count("upperChest"), 0U);
  EXPECT_EQ(bones.count("leftHand"), 1U);
}

TEST(HumanoidJoints, DeclaredOnesThatNoBodyCanHaveDoNotCount) {
  Skeleton person = declaredPerson();
  const auto before = jointsByBone(person);
  for (Joint& joint : person.joints) {
    joint.declaredBone = joint.name == before.at("head") ? "leftToes" : joint.name == before.at("neck") ? "hips" : "";
  }
  const auto bones = jointsByBone(person);
  EXPECT_EQ(bones.at("hips"), before.at("hips"));
  EXPECT_EQ(bones.at("head"), before.at("head"));
}

TEST(HumanoidJoints, PeopleUnderTheNamesOfSeveralPrograms) {
  for (const NameHabit habit : kNameHabits) {
    const MadeBody person = personWith(habit);
    const auto bones = jointsByBone(person.skeleton);
    for (Index j = 0; j < person.skeleton.jointCount(); ++j) {
      const BodyPart& part = person.parts[j];
      const std::string& name = person.skeleton.joints[j].name;
      const bool isLimb = part.kind == PartKind::kLeg || part.kind == PartKind::kArm;
      if (isLimb && part.segment != Segment::kWhole) {
        EXPECT_EQ(bones.at(nameOf(part)), name);
      }
      if (part == body_part::kNeck || part == body_part::kPelvis) {
        EXPECT_EQ(bones.at(nameOf(part)), name);
      }
    }
    EXPECT_EQ(bones.at("spine"), person.skeleton.joints[1].name);
    EXPECT_EQ(bones.at("chest"), person.skeleton.joints[2].name);
    EXPECT_EQ(bones.at("upperChest"), person.skeleton.joints[3].name);
    EXPECT_EQ(bones.at("head"), person.skeleton.joints[5].name);
  }
}

TEST(HumanoidJoints, PeopleWithoutNamesHaveTheSameBones) {
  const Skeleton person = vrmPerson();
  const auto named = humanoidJoints(person), nameless = humanoidJoints(testing::nameless(person));
  ASSERT_EQ(named.size(), nameless.size());
  for (std::size_t i = 0; i < named.size(); ++i) {
    EXPECT_EQ(named[i].bone, nameless[i].bone);
    EXPECT_EQ(named[i].joint, nameless[i].joint) << named[i].bone;
  }
}

TEST(HumanoidJoints, HipsOnTheGroundGiveWayToThoseInThePelvis) {
  const Skeleton person = onTheGround(vrmPerson(), {"leftUpperLeg", "rightUpperLeg"});
  EXPECT_EQ(jointsByBone(person).at("hips"), "hips");
  EXPECT_EQ(jointsByBone(person).at("spine"), "spine");
}

TEST(HumanoidJoints, FingersAreCountedFromTheHand) {
  MadeBody person = personWith(NameHabit::kMixamo);
  for (int finger = 0; finger < 5; ++finger) {
    const std::string stem = std::string("mixamorig:LeftHand") +
                             std::array{"Thumb", "Index", "Middle", "Ring", "Pinky"}[static_cast<std::size_t>(finger)];
    const Vec3 base(finger == 0 ? 0.7 : 0.77, 1.4, 0.05 - 0.02 * finger);
    addChain(person, stem, 4, "mixamorig:LeftHand", base, {0.03, 0, finger == 0 ? 0.02 : 0}, {});
  }
  const auto bones = jointsByBone(person.skeleton);
  EXPECT_EQ(bones.at("leftThumbMetacarpal"), "mixamorig:LeftHandThumb1");
  EXPECT_EQ(bones.at("leftThumbDistal"), "mixamorig:LeftHandThumb3");
  EXPECT_EQ(bones.at("leftIndexProximal"), "mixamorig:LeftHandIndex1");
  EXPECT_EQ(bones.at("leftLittleDistal"), "mixamorig:LeftHandPinky3");
  EXPECT_FALSE(bones.contains("rightIndexProximal"));
}

TEST(HumanoidJoints, AnimalsLegsAndWingsAreNoPeoples) {
  for (const auto& [bone, name] : jointsByBone(dog().skeleton)) EXPECT_EQ(bone.find("Leg"), std::string::npos) << name;
  for (const auto& [bone, name] : jointsByBone(crow().skeleton)) EXPECT_EQ(bone.find("Arm"), std::string::npos) << name;
  EXPECT_TRUE(humanoidJoints(Skeleton()).empty());
}

}  // namespace
}  // namespace limber
