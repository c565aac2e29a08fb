// Symmetric problems give symmetric answers: every method, with limits and restarts too.
#include "limber/skeleton/ik/ik_mirror.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "limber/core/rotation.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "limber/skeleton/ik/limits/humanoid_limits.h"
#include "random_values.h"

namespace limber {
namespace {

class IkMirrorTest : public ::testing::Test {
 protected:
  // Hands and feet anywhere near, the same on both sides, and the head in the middle.
  std::vector<IkTarget> symmetricTargets(testing::RandomValues& random) const {
    std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
    for (const std::size_t left : {0, 2}) {
      const Vec3 moved = random.uniform(0.05, 0.4) * random.direction();
      targets[left].position += moved;
      targets[left + 1].position += Vec3(-moved.x(), moved.y(), moved.z());
    }
    targets[4].position += Vec3(0, random.uniform(-0.1, 0), random.uniform(-0.1, 0.1));
    return targets;
  }

  // The largest angle between a joint and the image of the one opposite. The skeleton's joints all point as the world.
  double asymmetry(const Pose& pose) const {
    double worst = 0;
    for (Index j = 0; j < humanoid.jointCount(); ++j) {
      const std::string& name = humanoid.joints[j].name;
      if (name.rfind("right", 0) == 0) continue;
      const Index other = name.rfind("left", 0) == 0 ? humanoid.find("right" + name.substr(4)).value() : j;
      const Quat q = pose.locals[other].rotation;
      worst = std::max(worst, angleBetween(pose.locals[j].rotation, Quat(q.w(), q.x(), -q.y(), -q.z())));
    }
    return worst;
  }

  static bool isSymmetric(const Skeleton& skeleton, const Pose& pose, const std::vector<IkTarget>& targets,
                          const JointLimits* limits = nullptr) {
    IkSystem system(skeleton, targets, limits, {});
    system.load(pose, targets);
    return system.symmetric();
  }

  Skeleton humanoid = practiceHumanoid();
  JointLimits limits = humanoidLimits(humanoid, jointsCalledAsBones(humanoid));
};

TEST_F(IkMirrorTest, TheFirstTargetMayLieInTheMiddle) {
  std::vector<IkTarget> targets = practiceHumanoidTargets(humanoid);
  std::rotate(targets.begin(), targets.begin() + 4, targets.end());
  EXPECT_TRUE(isSymmetric(humanoid, restPose(humanoid), targets, &limits));
  targets.back().position.x() += 0.1;
  EXPECT_FALSE(isSymmetric(humanoid, restPose(humanoid), targets, &limits));
}

TEST_F(IkMirrorTest, EveryMethodKeepsBothSidesAlike) {
  for (const IkMethod& method : ikMethods()) {
    if (method.name == "two-bone") continue;
    testing::RandomValues random(5);
    for (int i = 0; i < 8; ++i) {
      const std::vector<IkTarget> targets = symmetricTargets(random);
      for (const JointLimits* limited : {static_cast<const JointLimits*>(nullptr), &std::as_const(limits)}) {
        IkOptions options;
        options.maxIterations = 60;
        options.restarts = 3;
        Pose pose = restPose(humanoid);
        solveIk(method, humanoid, pose, targets, limited, options);
        EXPECT_LT(asymmetry(pose), 1e-12) << method.name << (limited ? " with limits" : "");
        if (!limited) continue;
        for (Index j = 0; j < humanoid.jointCount(); ++j) {
          EXPECT_LT(limitViolation(limits.joints[j], pose.locals[j].rotation), 1e-4) << method.name;
        }
      }
    }
  }
}

TEST_F(IkMirrorTest, ACharacterThatHasTurnedRoundIsStillSymmetric) {
  testing::RandomValues random(6);
  std::vector<IkTarget> targets = symmetricTargets(random);
  Pose pose = restPose(humanoid);
  EXPECT_TRUE(isSymmetric(humanoid, pose, targets, &limits));
  const Affine transform = Eigen::Translation3d(1, 0, -2) * Eigen::AngleAxisd(0.7, Vec3(0.2, 1, 0.1).normalized());
  Transform& root = pose.locals[0];
  root = decompose(transform * root.toAffine());
  EXPECT_FALSE(isSymmetric(humanoid, pose, targets, &limits));
  for (IkTarget& target : targets) target.position = transform * target.position;
  EXPECT_TRUE(isSymmetric(humanoid, pose, targets, &limits));

  IkOptions options;
  options.rootMotion = RootMotion::kTranslate;
  solveIk(findIkMethod("whole-body"), humanoid, pose, targets, &limits, options);
  pose.locals[0].rotation = Quat::Identity();
  EXPECT_LT(asymmetry(pose), 1e-9);
}

TEST_F(IkMirrorTest, WhatDiffersBetweenTheSidesIsLeftSo) {
  testing::RandomValues random(7);
  const std::vector<IkTarget> targets = symmetricTargets(random);
  const Pose rest = restPose(humanoid);

  std::vector<IkTarget> other = targets;
  other[0].position.y() += 1e-3;
  EXPECT_FALSE(isSymmetric(humanoid, rest, other));
  other = targets;
  other[1].weight = 2;
  EXPECT_FALSE(isSymmetric(humanoid, rest, other));
  other = targets;
  other.erase(other.begin() + 1);
  EXPECT_FALSE(isSymmetric(humanoid, rest, other));

  Pose bent = rest;
  bent.locals[humanoid.find("leftLowerArm").value()].rotation = fromRotationVector(Vec3(0, 0.1, 0));
  EXPECT_FALSE(isSymmetric(humanoid, bent, targets));

  JointLimits stiff = limits;
  stiff.joints[humanoid.find("leftLowerArm").value()].stiffness = 0.5;
  EXPECT_FALSE(isSymmetric(humanoid, rest, targets, &stiff));
  JointLimits fixed = limits;
  fixed.joints[humanoid.find("rightLowerLeg").value()].motion = Hinge{{0, 0.1}};
  EXPECT_FALSE(isSymmetric(humanoid, rest, targets, &fixed));

  Skeleton lopsided = humanoid;
  lopsided.joints[humanoid.find("leftLowerArm").value()].rest.translation *= 1.01;
  EXPECT_FALSE(isSymmetric(lopsided, restPose(lopsided), targets));
}

}  // namespace
}  // namespace limber
