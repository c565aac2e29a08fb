#include "limber/character/matching/neutral_pose.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::inRestPose;
using limber::testing::turn;
using limber::testing::withOtherAxes;

class NeutralPoses : public ::testing::Test {
 protected:
  Vec3 bone(const Skeleton& skeleton, const char* from, const char* to) const {
    const NeutralPose pose =
        neutralPose(skeleton, restPose(skeleton), matchSkeletons(person, skeleton), MapSide::kTarget, Axes{});
    return (pose.positions[skeleton.find(to).value()] - pose.positions[skeleton.find(from).value()]).normalized();
  }

  Vec3 restBone(const Skeleton& skeleton, const char* from, const char* to) const {
    const std::vector<Affine> globals = restGlobals(skeleton);
    return (globals[skeleton.find(to).value()].translation() - globals[skeleton.find(from).value()].translation())
        .normalized();
  }

  const Skeleton person = practiceHumanoid();
};

TEST_F(NeutralPoses, ArmsToTheSidesLegsDownWhateverTheRestPoseIs) {
  const Skeleton bent = withOtherAxes(inRestPose(person, {{"leftUpperArm", turn(Vec3(0.3, 0.2, -1), 60)},
                                                          {"rightLowerArm", turn(Vec3::UnitY(), 40)},
                                                          {"leftUpperLeg", turn(Vec3::UnitZ(), 30)}}));
  EXPECT_LT((bone(bent, "leftUpperArm", "leftLowerArm") - Vec3::UnitX()).norm(), 1e-9);
  EXPECT_LT((bone(bent, "rightLowerArm", "rightHand") + Vec3::UnitX()).norm(), 1e-9);
  EXPECT_LT((bone(bent, "leftUpperLeg", "leftLowerLeg") + Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((bone(bent, "leftLowerLeg", "leftFoot") + Vec3::UnitY()).norm(), 1e-9);
}

// A statue that stoops and bows its head; of its shoulders and hips the same bones are left.
TEST_F(NeutralPoses, OneWhoStoopsStandsUp) {
  const Skeleton stooping = withOtherAxes(inRestPose(
      person,
      {{"hips", turn(Vec3::UnitX(), 35)}, {"chest", turn(Vec3(1, 0, 0.3), 50)}, {"neck", turn(Vec3::UnitX(), 20)}}));
  EXPECT_GT(std::acos(std::clamp(restBone(stooping, "hips", "neck").y(), -1.0, 1.0)), 0.8);
  EXPECT_GT(bone(stooping, "hips", "neck").y(), std::cos(5 * kPi / 180));
  EXPECT_GT(bone(stooping, "chest", "neck").y(), std::cos(26 * kPi / 180));
  EXPECT_LT((bone(stooping, "leftUpperLeg", "leftLowerLeg") + Vec3::UnitY()).norm(), 1e-9);
  EXPECT_LT((bone(stooping, "rightUpperArm", "rightLowerArm") + Vec3::UnitX()).norm(), 1e-9);
}

TEST_F(NeutralPoses, ABowedHeadIsRaised) {
  const Skeleton bowed = inRestPose(person, {{"neck", turn(Vec3::UnitX(), 60)}});
  EXPECT_GT(bone(bowed, "neck", "head").y(), std::cos(1e-6));
  EXPECT_LT((bone(bowed, "hips", "neck") - restBone(bowed, "hips", "neck")).norm(), 1e-9);
}

// Artists build people who lean a little, and dinosaurs that lean much on short arms.
TEST_F(NeutralPoses, ATrunkThatIsBuiltToLeanStaysSo) {
  const Skeleton leaning = inRestPose(person, {{"hips", turn(Vec3::UnitX(), 15)}, {"neck", turn(Vec3::UnitX(), 15)}});
  EXPECT_LT((bone(leaning, "hips", "neck") - restBone(leaning, "hips", "neck")).norm(), 1e-9);
  EXPECT_LT((bone(leaning, "neck", "head") - restBone(leaning, "neck", "head")).norm(), 1e-9);

  Skeleton dinosaur = inRestPose(person, {{"hips", turn(Vec3::UnitX(), 40)}});
  for (const char* name : {"leftLowerArm", "leftHand", "rightLowerArm", "rightHand"}) {
    dinosaur.joints[dinosaur.find(name).value()].rest.translation *= 0.3;
  }
  EXPECT_LT((bone(dinosaur, "hips", "neck") - restBone(dinosaur, "hips", "neck")).norm(), 1e-9);
}

// As of a bird, the foot's joint is a hock, high over the ground.
TEST_F(NeutralPoses, AFootAsLongAsTheShinStandsAsAtRest) {
  for (const bool bird : {true, false}) {
    Skeleton bent = person;
    for (const char* side : {"left", "right"}) {
      const auto joint = [&](const char* name) -> Joint& {
        return bent.joints[bent.find(std::string(side).append(name)).value()];
      };
      const double shin = joint("Foot").rest.translation.norm();
      joint("LowerLeg").rest.translation = Vec3(0, -0.8 * shin, 0.6 * shin);
      joint("Foot").rest.translation = Vec3(0, -0.6 * shin, -0.8 * shin);
      joint("Toes").rest.translation = (bird ? 1 : 0.4) * Vec3(0, -0.8 * shin, 0.6 * shin);
    }
    const Vec3 foot = bone(bent, "leftFoot", "leftToes"), atRest(0, -0.8, 0.6);
    EXPECT_EQ((foot - atRest).norm() < 1e-6, bird);
  }
}

// As rigs for inverse kinematics have them: such feet stay behind where the leg bends.
TEST_F(NeutralPoses, FeetOnARootOfTheirOwnEndTheLegs) {
  const Skeleton bent =
      inRestPose(person, {{"leftUpperLeg", turn(-Vec3::UnitX(), 40)}, {"leftLowerLeg", turn(Vec3::UnitX(), 70)}});
  const Skeleton loose = limber::testing::onTheGround(bent, {"leftFoot"});
  const NeutralPose pose = neutralPose(loose, restPose(loose), matchSkeletons(person, loose), MapSide::kTarget, Axes{});
  const Vec3 shin = pose.positions[loose.find("leftFoot").value()] - pose.positions[loose.find("leftLowerLeg").value()];
  const double length = person.joints[person.find("leftFoot").value()].rest.translation.norm();
  EXPECT_LT((shin + length * Vec3::UnitY()).norm(), 1e-6);
  const Vec3 foot = pose.positions[loose.find("leftToes").value()] - pose.positions[loose.find("leftFoot").value()];
  EXPECT_NEAR(foot.norm(), person.joints[person.find("leftToes").value()].rest.translation.norm(), 1e-6);
}

TEST_F(NeutralPoses, ToesAreFoundWhereTheOtherSkeletonHasNone) {
  const auto toes = [&](const Skeleton& skeleton, const Skeleton& other) {
    const SkeletonMap map = matchSkeletons(other, skeleton);
    const NeutralPose pose = neutralPose(skeleton, restPose(skeleton), map, MapSide::kTarget, Axes{});
    return toesOf(skeleton, map, MapSide::kTarget, Side::kLeft, pose.restPositions);
  };
  const Skeleton toeless = limber::testing::withoutToes(person);
  EXPECT_EQ(toes(person, person), person.find("leftToes"));
  EXPECT_EQ(toes(person, toeless), person.find("leftToes"));
  EXPECT_EQ(toes(toeless, person), std::nullopt);
  Skeleton heeled = toeless;
  Joint heel;
  heel.name = "heel";
  heel.parent = heeled.find("leftFoot");
  heel.rest.translation = Vec3(0, -0.05, -0.04);
  heeled.joints.push_back(heel);
  EXPECT_EQ(toes(heeled, person), std::nullopt) << "it lies behind the ankle";
}

TEST_F(NeutralPoses, ShinsWithHocksBendAndThoseWithTwistJointsDoNot) {
  const auto shinIsBent = [](const Skeleton& skeleton, const char* link) {
    const std::vector<Vec3> positions = restPositions(skeleton);
    const std::vector<Index> shin = {skeleton.find("leftLowerLeg").value(), skeleton.find(link).value()};
    return isBent(shin, skeleton.find("leftFoot").value(), positions);
  };
  EXPECT_TRUE(shinIsBent(limber::testing::withHocks(person), "leftHock"));
  EXPECT_FALSE(shinIsBent(limber::testing::withJointBefore(person, "leftFoot", "twist"), "twist"));
}

// Motions of some programs have a rest pose in which every bone points in the same direction.
TEST_F(NeutralPoses, AFoldedRestPoseGivesWayToAFrameThatStands) {
  Skeleton folded = person;
  for (Joint& joint : folded.joints) {
    if (joint.parent) joint.rest.translation = Vec3(joint.rest.translation.norm(), 0, 0);
  }
  const SkeletonMap map = matchSkeletons(person, person);
  EXPECT_TRUE(isUpright(person, restPose(person), map, MapSide::kSource));
  EXPECT_FALSE(isUpright(folded, restPose(folded), map, MapSide::kSource));
  Pose standing = restPose(folded), lying = standing;
  const Quat down = turn(-Vec3::UnitZ(), 90);
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) standing.locals[folded.find(leg).value()].rotation = down;
  standing.locals[folded.find("spine").value()].rotation = down.conjugate();
  const std::vector<Pose> motion = {lying, standing, lying};
  const Pose chosen = uprightPose(folded, motion, map, MapSide::kSource);
  EXPECT_TRUE(isUpright(folded, chosen, map, MapSide::kSource));
}

// A frame is under gravity, and faces where the motion goes: the pose that replaces the rest pose is turned to face +Z
// and to be upright, whatever it does there, so that the motion keeps its heading and a crawling motion stays one.
TEST_F(NeutralPoses, AFrameOfAMotionKeepsItsHeading) {
  const PoseSequence standing{{restPose(person)}, 1.0 / 30};
  const SkeletonMap map = matchSkeletons(person, person);
  for (const Quat& heading :
       {turn(Vec3::UnitY(), 37), turn(Vec3::UnitY(), 180), turn(Vec3::UnitX(), 80), turn(Vec3(0.4, 1, -0.2), 130)}) {
    const auto [flat, motion] = limber::testing::withZeroedAxes(
        person, limber::testing::turnedMotion(standing, heading), false, turn(Vec3(1, 1, 1), 120));
    const Pose upright = uprightPose(flat, motion.poses, map, MapSide::kSource);
    const NeutralPose neutral = neutralPose(flat, upright, map, MapSide::kSource, Axes{});
    EXPECT_LT(angleBetween(neutral.toBody, Quat::Identity()), 1e-6);
    const std::vector<Vec3> expected = restPositions(person);
    for (Index j = 0; j < person.jointCount(); ++j) {
      const Vec3 is = neutral.positions[j] - neutral.positions[0], right = expected[j] - expected[0];
      EXPECT_LT((is - right).norm(), 0.06) << person.joints[j].name;  // metres: the trunk leans a little at rest
    }
  }
}

// Arms and legs on one line with the trunk, the right ones to its other side: together the feet are opposite to
// nothing.
TEST_F(NeutralPoses, AMirroredFlatRestPoseDoesNotStand) {
  const PoseSequence standing{{restPose(person)}, 1.0 / 30};
  const auto [flat, motion] = limber::testing::withZeroedAxes(person, standing, true, turn(Vec3::UnitZ(), 90));
  EXPECT_FALSE(isUpright(flat, restPose(flat), matchSkeletons(person, person), MapSide::kSource));
}

}  // namespace
}  // namespace limber
