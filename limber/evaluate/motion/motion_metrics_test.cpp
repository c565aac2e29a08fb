// The measures on motions that are off by known amounts.
#include "limber/evaluate/motion/motion_metrics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

constexpr double kSeconds = 1.0 / 60;

class MotionMetricsOf : public ::testing::Test {
 protected:
  // A person in rest pose, at `position` and moved by `displacement` in each frame.
  PoseSequence standing(const Vec3& position, const Vec3& displacement = Vec3::Zero()) const {
    PoseSequence frames{std::vector<Pose>(40, restPose(person_)), kSeconds};
    for (std::size_t f = 0; f < frames.poses.size(); ++f) {
      frames.poses[f].locals[hips_].translation += position + static_cast<double>(f) * displacement;
    }
    return frames;
  }
  RetargetSetup setup(const PoseSequence& motion) const {
    return {person_, person_, matchSkeletons(person_, person_), {}, &motion};
  }

  const Skeleton person_ = practiceHumanoid();
  const Index hips_ = person_.find("hips").value();
};

TEST_F(MotionMetricsOf, TheSameIsPerfect) {
  const PoseSequence motion = limber::testing::walk(person_);
  const MotionMetrics metrics = measureMotion(setup(motion), motion, motion);
  EXPECT_EQ(metrics.frames, 120u);
  EXPECT_LT(metrics.boneDirection, 1e-6);
  EXPECT_LT(metrics.endEffector, 1e-9);
  EXPECT_GT(metrics.planted, 0.2);
  EXPECT_EQ(metrics.sliding, metrics.sourceSliding);
  EXPECT_EQ(metrics.contactAgreement, 1);
  EXPECT_NEAR(metrics.jerk, 1, 1e-12);
}

TEST_F(MotionMetricsOf, FeetThatSlideAndSinkDoSoByTheirWay) {
  const PoseSequence still = standing(Vec3::Zero());
  const Vec3 displacement(0.0005, 0, 0);  // a frame
  const MotionMetrics metrics = measureMotion(setup(still), still, standing(Vec3(0, -0.02, 0), displacement));
  EXPECT_EQ(metrics.planted, 1);
  EXPECT_EQ(metrics.sourceSliding, 0);
  EXPECT_NEAR(metrics.sliding * metrics.height, displacement.x() / kSeconds, 1e-9);
  EXPECT_NEAR(metrics.penetration * metrics.height, 0.02, 1e-9);
  EXPECT_EQ(metrics.sourcePenetration, 0);
  EXPECT_EQ(metrics.contactAgreement, 1);
  const MotionMetrics lifted = measureMotion(setup(still), still, standing(Vec3(0, 0.5, 0)));
  EXPECT_EQ(lifted.contactAgreement, 0);
}

TEST_F(MotionMetricsOf, ToesThatTheSourceLacksSinkAsWell) {
  const Skeleton toeless = limber::testing::withoutToes(person_);
  PoseSequence from{std::vector<Pose>(40, restPose(toeless)), kSeconds}, to = standing(Vec3::Zero());
  const RetargetSetup setup(toeless, person_, matchSkeletons(toeless, person_), {}, &from);
  EXPECT_LT(measureMotion(setup, from, to).penetration, 1e-9);
  const Index foot = person_.find("leftFoot").value(), toes = person_.find("leftToes").value();
  to.poses[20].locals[foot].rotation = limber::testing::turn(Vec3::UnitX(), 30);
  const double deep =
      restGlobals(person_)[toes].translation().y() - poseGlobals(person_, to.poses[20])[toes].translation().y();
  const MotionMetrics metrics = measureMotion(setup, from, to);
  EXPECT_GT(deep, 0.02);
  EXPECT_NEAR(metrics.penetration * metrics.height, deep, 1e-9);
}

// A snake has no legs: of its ten joints one is off.
TEST(MotionMetrics, WithoutLegsTurnsOfJointsCount) {
  Skeleton snake;
  for (int i = 0; i < 10; ++i) {
    limber::testing::addJoint(snake, std::string("part").append(std::to_string(i)),
                              i > 0 ? std::string("part").append(std::to_string(i - 1)) : "", Vec3(0, 0, -0.2));
  }
  PoseSequence motion{std::vector<Pose>(40, restPose(snake)), kSeconds};
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    motion.poses[f].locals[4].rotation =
        limber::testing::turn(Vec3::UnitY(), 20 * std::sin(0.3 * static_cast<double>(f)));
  }
  const RetargetSetup setup(snake, snake, matchSkeletons(snake, snake), {}, &motion);
  const MotionMetrics same = measureMotion(setup, motion, motion);
  EXPECT_FALSE(same.hasLegs);
  EXPECT_LT(same.boneDirection, 1e-6);
  EXPECT_NEAR(same.jerk, 1, 1e-12);
  PoseSequence off = motion;
  for (Pose& pose : off.poses) pose.locals[9].rotation = limber::testing::turn(Vec3::UnitX(), 30);
  EXPECT_NEAR(measureMotion(setup, motion, off).boneDirection, 30.0 / 10, 1e-6);
  PoseSequence rough = motion;
  for (std::size_t f = 0; f < rough.poses.size(); f += 7) {
    rough.poses[f].locals[7].rotation = limber::testing::turn(Vec3::UnitX(), 15);
  }
  EXPECT_GT(measureMotion(setup, motion, rough).jerk, 2);
  EXPECT_EQ(toText(same).find("foot sliding"), std::string::npos);
}

TEST_F(MotionMetricsOf, ATurnedForearmIsOneBoneOfEight) {
  const PoseSequence still = standing(Vec3::Zero());
  PoseSequence turned = still;
  for (Pose& pose : turned.poses) {
    pose.locals[person_.find("leftLowerArm").value()].rotation = limber::testing::turn(Vec3::UnitZ(), 40);
  }
  EXPECT_NEAR(measureMotion(setup(still), still, turned).boneDirection, 40.0 / 8, 1e-6);
}

// A thigh's scale that differs between the axes makes the shin longer where the file's is, and not by the mean.
TEST_F(MotionMetricsOf, UnevenScalesCountAsTheFileShowsThem) {
  Skeleton uneven = person_;
  uneven.joints[uneven.find("leftUpperLeg").value()].rest.scale = Vec3(1, 1.1, 1);
  const PlainSkeleton plain(uneven);
  const PoseSequence still = standing(Vec3::Zero()), shown{std::vector<Pose>(40, restPose(uneven)), kSeconds};
  const PoseSequence even = plain.plain(shown);
  const RetargetSetup setup(person_, plain.skeleton(), matchSkeletons(person_, plain.skeleton()), {}, &still);
  const ShownJoints joints = shownJoints(uneven, shown, setup.targetKinematics.toBody());
  const Index toes = uneven.find("leftToes").value();
  const auto heightIn = [&](const Skeleton& skeleton) { return restGlobals(skeleton)[toes].translation().y(); };
  const double deep = heightIn(plain.skeleton()) - heightIn(uneven);
  ASSERT_GT(deep, 0.01);
  const MotionMetrics byMean = measureMotion(setup, still, even),
                      asShown = measureMotion(setup, still, even, nullptr, &joints);
  EXPECT_NEAR((asShown.penetration - byMean.penetration) * byMean.height, deep, 1e-6);
  EXPECT_NEAR(jointErrorOf(setup, even, even, &joints, &joints).global, 0, 1e-12);
  EXPECT_GT(jointErrorOf(setup, even, even, nullptr, &joints).global, 0);
}

// The same angles on other proportions are as smooth, whatever the joints' paths are.
TEST_F(MotionMetricsOf, JerkIsThatOfTheBonesOnAnyProportions) {
  Skeleton uneven = person_;
  for (const std::string side : {"left", "right"}) {
    const auto bone = [&](const char* end) -> Vec3& {
      return uneven.joints[uneven.find(side + end).value()].rest.translation;
    };
    bone("Hand") *= 1.6;
    // Legs stay as long, and the pelvis goes as it did.
    const double longer = 0.3 * bone("LowerLeg").norm();
    bone("LowerLeg") *= 1.3;
    bone("Foot") *= 1 - longer / bone("Foot").norm();
  }
  const PoseSequence motion = limber::testing::walk(person_);
  const RetargetSetup to(person_, uneven, matchSkeletons(person_, uneven), {}, &motion);
  const MotionMetrics metrics = measureMotion(to, motion, retargetFrames(findRetargetMethod("aligned"), to, motion));
  EXPECT_NEAR(metrics.jerk, 1, 1e-6);
  EXPECT_GT(std::abs(metrics.jointJerk - 1), 0.05) << metrics.jointJerk;
}

TEST_F(MotionMetricsOf, JerkShowsWhatTrembles) {
  const PoseSequence motion = limber::testing::walk(person_);
  const auto jerkWith = [&](const char* joint, double degrees, double metres) {
    PoseSequence noisy = motion;
    for (std::size_t f = 0; f < noisy.poses.size(); ++f) {
      Transform& local = noisy.poses[f].locals[person_.find(joint).value()];
      const double wave = std::sin(2.1 * static_cast<double>(f));
      local.rotation = limber::testing::turn(Vec3::UnitX(), degrees * wave) * local.rotation;
      local.translation += Vec3(0, metres * wave, 0);
    }
    return measureMotion(setup(motion), motion, noisy).jerk;
  };
  EXPECT_GT(jerkWith("leftLowerLeg", 1, 0), 1.1);
  EXPECT_GT(jerkWith("rightUpperArm", 1, 0), 1.1);
  EXPECT_GT(jerkWith("hips", 0, 0.01), 1.1);
}

TEST_F(MotionMetricsOf, JointErrorIsOverTheSquareOfTheHeight) {
  const PoseSequence still = standing(Vec3::Zero()), aside = standing(Vec3(0.3, 0, 0));
  const double height = measureMotion(setup(still), still, still).height;
  const JointError error = jointErrorOf(setup(still), still, aside);
  EXPECT_NEAR(error.global, 0.09 / (height * height), 1e-9);
  EXPECT_LT(error.rootRelative, 1e-12);
}

TEST(MotionMetricsOfAnimals, AreThoseOfTheirLegs) {
  const Skeleton animal = limber::testing::quadruped(0.5);
  PoseSequence still{std::vector<Pose>(40, restPose(animal)), kSeconds}, sliding = still;
  for (std::size_t f = 0; f < sliding.poses.size(); ++f) {
    sliding.poses[f].locals[0].translation += Vec3(0.0005 * static_cast<double>(f), -0.01, 0);
  }
  const RetargetSetup setup(animal, animal, matchSkeletons(animal, animal), {}, &still);
  const MotionMetrics metrics = measureMotion(setup, still, sliding);
  EXPECT_EQ(metrics.planted, 1);
  EXPECT_NEAR(metrics.sliding * metrics.height, 0.0005 / kSeconds, 1e-9);
  EXPECT_NEAR(metrics.penetration * metrics.height, 0.01, 1e-9);
  EXPECT_LT(metrics.boneDirection, 1e-6);
}

TEST_F(MotionMetricsOf, RefusesFramesThatDiffer) {
  const PoseSequence still = standing(Vec3::Zero());
  PoseSequence shorter = still;
  shorter.poses.resize(4);
  EXPECT_THROW(measureMotion(setup(still), still, shorter), Error);
  EXPECT_THROW(measureMotion(setup(still), shorter, shorter), Error);
}

TEST_F(MotionMetricsOf, WhatWasNotMeasuredIsNotWritten) {
  MotionMetrics metrics;
  EXPECT_FALSE(toJson(metrics).contains("self_penetration_share"));
  EXPECT_EQ(toText(metrics).find("joint error"), std::string::npos);
  metrics.selfPenetration = SelfPenetration{0.01, 0.02, 7};
  metrics.jointError = JointError{0.5, 0.25};
  const Json json = toJson(metrics);
  EXPECT_EQ(json.at("worst_self_penetration_frame"), 7);
  EXPECT_EQ(json.at("root_relative_joint_error"), 0.25);
  EXPECT_NE(toText(metrics).find("1.00 % of the vertices, 2.00 % in frame 7"), std::string::npos);
}

}  // namespace
}  // namespace limber
