#include "limber/skeleton/ik/limits/humanoid_limits.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"

namespace limber {
namespace {

class HumanoidLimits : public ::testing::Test {
 protected:
  HumanoidLimits() : limits(humanoidLimits(skeleton, jointsCalledAsBones(skeleton))) {}

  Index joint(const char* name) const { return skeleton.find(name).value(); }

  // How far the joint is from what it may do when turned from rest by degrees about a global axis.
  double violation(const char* name, const Vec3& axis, double degrees) const {
    const Quat turn(Eigen::AngleAxisd(degrees * kPi / 180, axis.normalized()));
    return limitViolation(limits.joints[joint(name)], turn * skeleton.joints[joint(name)].rest.rotation) * 180 / kPi;
  }

  // Rest rotations of the practice humanoid are identities, so global axes are local ones.
  Skeleton skeleton = practiceHumanoid();
  JointLimits limits;
};

TEST_F(HumanoidLimits, TheTPoseIsAllowed) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    checkLimit(limits.joints[j], skeleton.joints[j].name);
    EXPECT_LT(limitViolation(limits.joints[j], skeleton.joints[j].rest.rotation), 1e-9) << skeleton.joints[j].name;
  }
}

TEST_F(HumanoidLimits, KneesBendBackwardOnly) {
  for (const char* knee : {"leftLowerLeg", "rightLowerLeg"}) {
    EXPECT_NEAR(violation(knee, Vec3::UnitX(), 120), 0, 1e-6) << "the heel goes to the back";
    EXPECT_NEAR(violation(knee, -Vec3::UnitX(), 30), 30, 1e-6);
    EXPECT_NEAR(violation(knee, Vec3::UnitX(), 155), 20, 1e-6);
  }
}

TEST_F(HumanoidLimits, ElbowsBringHandsForward) {
  EXPECT_NEAR(violation("leftLowerArm", -Vec3::UnitY(), 140), 0, 1e-6);
  EXPECT_NEAR(violation("leftLowerArm", Vec3::UnitY(), 20), 20, 1e-6);
  EXPECT_NEAR(violation("rightLowerArm", Vec3::UnitY(), 140), 0, 1e-6);
  EXPECT_NEAR(violation("rightLowerArm", -Vec3::UnitY(), 20), 20, 1e-6);
}

TEST_F(HumanoidLimits, ArmsHangAndRise) {
  EXPECT_NEAR(violation("leftUpperArm", Vec3::UnitZ(), -90), 0, 1e-6) << "down at the side";
  EXPECT_NEAR(violation("leftUpperArm", Vec3::UnitZ(), 85), 0, 1e-6) << "up beside the head";
  EXPECT_NEAR(violation("rightUpperArm", Vec3::UnitZ(), 90), 0, 1e-6);
  EXPECT_NEAR(violation("rightUpperArm", Vec3::UnitZ(), -85), 0, 1e-6);
}

TEST_F(HumanoidLimits, LegsSpreadOutwardFurtherThanInward) {
  EXPECT_NEAR(violation("leftUpperLeg", Vec3::UnitZ(), 44), 0, 1e-6);
  EXPECT_NEAR(violation("leftUpperLeg", -Vec3::UnitZ(), 44), 14, 1e-6);
  EXPECT_NEAR(violation("rightUpperLeg", -Vec3::UnitZ(), 44), 0, 1e-6);
  EXPECT_NEAR(violation("rightUpperLeg", Vec3::UnitZ(), 44), 14, 1e-6);
}

// Mirrored rotations break mirrored limits by the same angle.
TEST_F(HumanoidLimits, RightMirrorsLeft) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::string& name = skeleton.joints[j].name;
    if (name.rfind("left", 0) != 0) continue;
    const Index other = joint(("right" + name.substr(4)).c_str());
    for (int i = 0; i < 50; ++i) {
      const Quat turn = fromRotationVector(1.5 * Vec3(std::sin(i), std::sin(2.3 * i), std::sin(4.1 * i)));
      const Quat image(turn.w(), turn.x(), -turn.y(), -turn.z());
      EXPECT_NEAR(limitViolation(limits.joints[j], turn), limitViolation(limits.joints[other], image), 1e-9) << name;
    }
  }
}

// A rest pose with hanging arms has the same limits in space.
TEST_F(HumanoidLimits, OtherRestPosesAreBentToATPoseFirst) {
  Skeleton hanging = skeleton;
  const Index arm = joint("leftUpperArm"), elbow = joint("leftLowerArm");
  hanging.joints[arm].rest.rotation = Quat(Eigen::AngleAxisd(-kPi / 3, Vec3::UnitZ()));
  const JointLimits same = humanoidLimits(hanging, jointsCalledAsBones(hanging));
  for (const Index j : {arm, elbow}) {
    for (int i = 0; i < 50; ++i) {
      const Quat local = fromRotationVector(1.5 * Vec3(std::sin(i), std::sin(2.3 * i), std::sin(4.1 * i)));
      EXPECT_NEAR(limitViolation(limits.joints[j], local), limitViolation(same.joints[j], local), 1e-9);
    }
  }
}

TEST_F(HumanoidLimits, TheSpineSharesItsRange) {
  const double three = violation("spine", Vec3::UnitX(), 40);
  EXPECT_NEAR(three, 40 - 80 / 3.0, 1e-6);
  std::vector<HumanoidJoint> two = jointsCalledAsBones(skeleton);
  two.erase(std::remove_if(two.begin(), two.end(), [](const HumanoidJoint& j) { return j.bone == "upperChest"; }),
            two.end());
  limits = humanoidLimits(skeleton, two);
  EXPECT_NEAR(violation("spine", Vec3::UnitX(), 50), 10, 1e-6);
  EXPECT_EQ(violation("upperChest", Vec3::UnitX(), 50), 0);
}

TEST_F(HumanoidLimits, EveryFigureHasASource) {
  for (const HumanoidRange& range : humanoidRanges()) EXPECT_FALSE(range.source.empty()) << range.bone;
  const HumanoidJoint nowhere{"head", 99};
  EXPECT_THROW(humanoidLimits(skeleton, {&nowhere, 1}), Error);
}

}  // namespace
}  // namespace limber
