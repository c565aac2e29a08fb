#include "limber/matching/humanoid_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "limber/matching/humanoid_shape.h"
#include "limber/matching/skeleton_map.h"
#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

// Of the bones whose names hold `part`.
double leastConfidence(const Skeleton& skeleton, const std::string& part = "") {
  double least = 1;
  for (const HumanoidJoint& joint : humanoidJointsByShape(skeleton)) {
    if (joint.bone.find(part) != std::string::npos) least = std::min(least, joint.confidence);
  }
  return least;
}

TEST(HumanoidFit, ACleanPersonIsSure) {
  EXPECT_GE(leastConfidence(practiceHumanoid()), kDoubtful);
  EXPECT_LT(leastConfidence(practiceHumanoid()), 0.95);  // a name says more
}

TEST(HumanoidFit, ATailIsOdd) {
  Skeleton tailed = practiceHumanoid();
  Joint tail;
  tail.name = "tail";
  tail.parent = tailed.find("hips").value();
  tail.rest.translation = Vec3(0, 0.1, -0.9);
  tailed.joints.push_back(tail);
  EXPECT_LT(leastConfidence(tailed), kDoubtful);
}

TEST(HumanoidFit, WithoutToesLeftIsAGuess) {
  const Skeleton whole = practiceHumanoid();
  Skeleton person = whole;
  std::erase_if(person.joints, [](const Joint& joint) { return joint.name.ends_with("Toes"); });
  for (Joint& joint : person.joints) {
    if (joint.parent) joint.parent = person.find(whole.joints[*joint.parent].name);
  }
  EXPECT_LT(leastConfidence(person, "left"), kDoubtful);
  EXPECT_GE(leastConfidence(person, "hips"), kDoubtful);
}

TEST(HumanoidFit, OddArmsAndLegsAreDoubtful) {
  Skeleton person = practiceHumanoid();
  for (Joint& joint : person.joints) {
    if (joint.name == "leftHand" || joint.name == "rightHand") joint.rest.translation *= 0.3;
  }
  EXPECT_LT(leastConfidence(person, "Arm"), kDoubtful);
  EXPECT_GE(leastConfidence(person, "Leg"), kDoubtful);
  for (Joint& joint : person.joints) {
    if (joint.name == "rightUpperLeg") joint.rest.translation += Vec3(0, -0.05, 0.1);
  }
  EXPECT_LT(leastConfidence(person, "Leg"), kDoubtful);
}

}  // namespace
}  // namespace limber
