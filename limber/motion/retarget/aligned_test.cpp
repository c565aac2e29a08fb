#include "limber/motion/retarget/aligned.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/retarget/retarget_clip.h"

namespace limber {
namespace {

using limber::testing::inRestPose;
using limber::testing::renamed;
using limber::testing::scaled;
using limber::testing::turn;
using limber::testing::walk;
using limber::testing::withJointBefore;
using limber::testing::withOtherAxes;
using limber::testing::worstDirection;

class Aligned : public ::testing::Test {
 protected:
  double directionsOn(const Skeleton& target) {
    const RetargetSetup setup(person, target, matchSkeletons(person, target), {}, &motion);
    EXPECT_TRUE(setup.person);
    return worstDirection(setup, motion, retargetFrames(findRetargetMethod("aligned"), setup, motion));
  }

  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = walk(person);
};

TEST_F(Aligned, TheSameSkeletonMovesTheSame) {
  for (const RetargetMethod& method : retargetMethods()) {
    const RetargetSetup setup(person, person, matchSkeletons(person, person), {}, &motion);
    const PoseSequence result = retargetFrames(method, setup, motion);
    for (std::size_t f = 0; f < motion.poses.size(); ++f) {
      const std::vector<Affine> expected = poseGlobals(person, motion.poses[f]);
      const std::vector<Affine> given = poseGlobals(person, result.poses[f]);
      for (Index j = 0; j < person.jointCount(); ++j) {
        ASSERT_LT((expected[j].matrix() - given[j].matrix()).norm(), 1e-5)
            << method.name << " " << person.joints[j].name << " in frame " << f;
      }
    }
  }
}

TEST_F(Aligned, OtherNamesAxesAndSizesKeepDirections) {
  EXPECT_LT(directionsOn(renamed(person)), 1e-5);
  EXPECT_LT(directionsOn(withOtherAxes(person)), 1e-5);
  EXPECT_LT(directionsOn(scaled(withOtherAxes(renamed(person)), 3.7)), 1e-5);
}

// Turns across the bones: how a bone is twisted about itself cannot be seen in where joints are.
TEST_F(Aligned, OtherRestPosesKeepDirections) {
  const Skeleton aPose =
      inRestPose(person, {{"leftUpperArm", turn(Vec3::UnitZ(), -50)}, {"rightUpperArm", turn(Vec3::UnitZ(), 50)}});
  const Skeleton bent = inRestPose(person, {{"leftUpperArm", turn(Vec3(0, 0.2, -1), 80)},
                                            {"leftLowerArm", turn(Vec3::UnitY(), -15)},
                                            {"rightUpperLeg", turn(Vec3::UnitZ(), -40)},
                                            {"leftUpperLeg", turn(Vec3::UnitZ(), 40)}});
  EXPECT_LT(directionsOn(aPose), 0.5);
  EXPECT_LT(directionsOn(withOtherAxes(aPose)), 0.5);
  EXPECT_LT(directionsOn(bent), 0.5);
}

TEST_F(Aligned, FurtherTwistAndSpineJointsKeepDirections) {
  Skeleton more = withJointBefore(person, "leftLowerArm", "leftArmHalf");
  more = withJointBefore(more, "rightFoot", "rightShinHalf");
  EXPECT_LT(directionsOn(more), 0.5);
  EXPECT_LT(directionsOn(withJointBefore(person, "neck", "spineTop")), 0.5);
}

// A shin of one joint, or of two in a line, points from knee to foot as one with a hock does, however that bends.
TEST_F(Aligned, AShinWithAHockIsOneBoneForOthers) {
  const Skeleton hocked = limber::testing::withHocks(person);
  PoseSequence bending{{}, 1.0 / 30};
  for (int f = 0; f < 20; ++f) {
    Pose& pose = bending.poses.emplace_back(restPose(hocked));
    pose.locals[hocked.find("leftLowerLeg").value()].rotation = turn(Vec3::UnitX(), 2 * f);
    pose.locals[hocked.find("leftHock").value()].rotation = turn(-Vec3::UnitX(), 3 * f);
  }
  for (const Skeleton& target : {person, withJointBefore(person, "leftFoot", "leftShinHalf")}) {
    const RetargetSetup setup(hocked, target, matchSkeletons(hocked, target), {}, &bending);
    EXPECT_LT(worstDirection(setup, bending, retargetFrames(findRetargetMethod("aligned"), setup, bending)), 1e-5);
  }
}

TEST_F(Aligned, WhichWayTheRestPoseFacesDoesNotMatter) {
  Skeleton turned = person;
  turned.joints[0].rest.rotation = turn(Vec3::UnitY(), 90);
  turned.joints[0].rest.translation = turn(Vec3::UnitY(), 90) * turned.joints[0].rest.translation;
  EXPECT_LT(directionsOn(turned), 1e-5);
  Skeleton lying = person;
  lying.joints[0].rest.rotation = turn(Vec3::UnitX(), 90);
  lying.joints[0].rest.translation = turn(Vec3::UnitX(), 90) * lying.joints[0].rest.translation;
  EXPECT_LT(directionsOn(lying), 1e-5) << "up is told by the body, not by an axis";
}

TEST_F(Aligned, TheWayScalesWithTheHips) {
  const Skeleton giant = scaled(person, 2.5);
  const RetargetSetup setup(person, giant, matchSkeletons(person, giant), {}, &motion);
  EXPECT_NEAR(setup.scale, 2.5, 1e-9);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, motion);
  const Vec3 displacement = motion.poses.back().locals[0].translation - motion.poses.front().locals[0].translation;
  const Vec3 giants = result.poses.back().locals[0].translation - result.poses.front().locals[0].translation;
  EXPECT_LT((giants - 2.5 * displacement).norm(), 1e-6);

  RetargetOptions unscaled;
  unscaled.rootScale = RootScale::kNone;
  EXPECT_EQ(RetargetSetup(person, giant, matchSkeletons(person, giant), unscaled, &motion).scale, 1);
}

// A tail of many joints coils up until its end has turned nearly twice; one of two joints turns as evenly.
TEST(AlignedChains, CoilsDoNotFlip) {
  const auto snake = [](int joints) {
    Skeleton made;
    limber::testing::addJoint(made, "body", "", Vec3::Zero());
    for (int i = 1; i <= joints; ++i) {
      limber::testing::addJoint(made, "tail" + std::to_string(i), i > 1 ? "tail" + std::to_string(i - 1) : "body",
                                Vec3(0, 0, -2.0 / joints));
    }
    return made;
  };
  const Skeleton many = snake(20), few = snake(2);
  SkeletonMap map;
  map.matches = {{body_part::kTrunk, {0}, {0}, 1, MatchedBy::kFile},
                 {body_part::kTail, {}, {1, 2}, 1, MatchedBy::kFile}};
  for (Index j = 1; j < many.jointCount(); ++j) map.matches[1].source.push_back(j);
  PoseSequence coiling{{}, 1.0 / 30};
  for (int f = 0; f <= 170; ++f) {
    coiling.poses.push_back(restPose(many));
    for (Index j = 1; j < many.jointCount(); ++j) {
      coiling.poses.back().locals[j].rotation = turn(Vec3::UnitY(), 0.2 * f);
    }
  }
  const RetargetSetup setup(many, few, map, {}, &coiling);
  const PoseSequence result = retargetFrames(findRetargetMethod("aligned"), setup, coiling);
  for (std::size_t f = 1; f < result.poses.size(); ++f) {
    for (const Index joint : {1u, 2u}) {
      const Quat now = result.poses[f].locals[joint].rotation, before = result.poses[f - 1].locals[joint].rotation;
      EXPECT_LT(now.angularDistance(before) * 180 / kPi, 3) << f;
    }
  }
}

TEST_F(Aligned, ThereAndBackAgain) {
  const Skeleton other = withOtherAxes(scaled(
      inRestPose(person, {{"leftUpperArm", turn(Vec3::UnitZ(), -45)}, {"rightUpperArm", turn(Vec3::UnitZ(), 45)}}),
      1.3));
  for (const char* name : {"aligned", "limb-ik"}) {
    const RetargetMethod& method = findRetargetMethod(name);
    const RetargetSetup there(person, other, matchSkeletons(person, other), {}, &motion);
    const PoseSequence away = retargetFrames(method, there, motion);
    const RetargetSetup back(other, person, matchSkeletons(other, person), {}, &away);
    const PoseSequence home = retargetFrames(method, back, away);
    double sum = 0, count = 0;
    for (std::size_t f = 0; f < motion.poses.size(); ++f) {
      const std::vector<Affine> expected = poseGlobals(person, motion.poses[f]);
      const std::vector<Affine> given = poseGlobals(person, home.poses[f]);
      for (Index j = 0; j < person.jointCount(); ++j, ++count) {
        sum += (expected[j].translation() - given[j].translation()).norm();
      }
    }
    EXPECT_LT(sum / count, 0.01 * 1.7) << name;
  }
}

}  // namespace
}  // namespace limber
