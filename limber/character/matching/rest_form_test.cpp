#include "limber/character/matching/rest_form.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using limber::testing::MovedSkeleton;
using limber::testing::nameless;
using limber::testing::turn;
using limber::testing::turnedMotion;
using limber::testing::walk;
using limber::testing::withZeroedAxes;

class RestForm : public ::testing::Test {
 protected:
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = walk(person);
};

bool restHasForm(const Skeleton& skeleton) {
  return hasForm(skeleton, restPose(skeleton));
}

TEST_F(RestForm, BonesOnOneLineHaveNone) {
  for (const bool mirrored : {false, true}) {
    const MovedSkeleton flat = withZeroedAxes(person, motion, mirrored, turn(Vec3(1, 1, 1), 120));
    EXPECT_FALSE(restHasForm(flat.skeleton));
    EXPECT_FALSE(restHasForm(testing::turnedAsAWhole(flat.skeleton, turn(Vec3(1, 2, 3), 77))));
    EXPECT_TRUE(hasForm(flat.skeleton, flat.motion.poses.front()));
  }
}

// On a root at the ground: the path from there to the hips is no limb.
TEST_F(RestForm, ARootBelowTheHipsGivesNone) {
  const MovedSkeleton flat = withZeroedAxes(person, motion, false, Quat::Identity());
  Skeleton rooted;
  testing::addJoint(rooted, "root", "", Vec3::Zero());
  for (Joint joint : flat.skeleton.joints) {
    joint.parent = joint.parent ? *joint.parent + 1 : 0;
    rooted.joints.push_back(joint);
  }
  ASSERT_GT(rooted.joints[1].rest.translation.y(), 0.5);
  EXPECT_FALSE(restHasForm(rooted));
}

TEST_F(RestForm, BodiesHaveOne) {
  const Skeleton hanging = testing::inRestPose(
      person, {{"leftUpperArm", turn(Vec3::UnitZ(), -90)}, {"rightUpperArm", turn(Vec3::UnitZ(), 90)}});
  for (const Skeleton& body : {person, hanging, testing::quadruped(0.5), testing::snake().skeleton,
                               testing::fish().skeleton, testing::spider().skeleton, Skeleton()}) {
    EXPECT_TRUE(restHasForm(body));
  }
}

TEST_F(RestForm, APoseStandsInForOneWithout) {
  EXPECT_FALSE(poseWithForm(person, motion.poses));
  const MovedSkeleton flat = withZeroedAxes(person, motion, true, Quat::Identity());
  const std::vector<Pose> still(3, restPose(flat.skeleton));
  EXPECT_FALSE(poseWithForm(flat.skeleton, still));
  EXPECT_FALSE(poseWithForm(flat.skeleton, {}));
  const std::optional<Pose> pose = poseWithForm(flat.skeleton, flat.motion.poses);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(hasForm(flat.skeleton, *pose));
  EXPECT_TRUE(restHasForm(restingIn(flat.skeleton, *pose)));
}

// By form alone, since no name tells, and whatever the hips' axes are: each part of the one that rests in T-pose.
TEST_F(RestForm, TheSourceIsReadInThatPose) {
  const Skeleton other = nameless(testing::oddlyBuilt());
  const SkeletonMap right = matchSkeletons(nameless(person, "p"), other);
  ASSERT_TRUE(right.isBiped());
  for (const bool mirrored : {false, true}) {
    for (const Quat& hips : {Quat(Quat::Identity()), turn(Vec3::UnitZ(), 90), turn(Vec3(1, 1, 1), 240)}) {
      const MovedSkeleton flat = withZeroedAxes(person, motion, mirrored, hips);
      const Skeleton source = nameless(flat.skeleton, "p");
      const std::optional<Pose> pose = poseWithForm(source, flat.motion.poses);
      ASSERT_TRUE(pose);
      const SkeletonMap map = matchSkeletons(source, other, false, &*pose);
      for (const char* part : {"hips", "head", "leftUpperArm", "leftHand", "rightLowerArm", "leftUpperLeg", "leftFoot",
                               "rightLowerLeg", "rightFoot"}) {
        const JointMatch *is = testing::matchOf(map, part), *expected = testing::matchOf(right, part);
        ASSERT_TRUE(is && expected) << part;
        EXPECT_EQ(is->source, expected->source) << part;
        EXPECT_EQ(is->target, expected->target) << part;
      }
    }
  }
}

TEST_F(RestForm, TwinsAreFoundAllTheSame) {
  const MovedSkeleton flat = withZeroedAxes(person, motion, true, turn(Vec3::UnitZ(), 90));
  const std::optional<Pose> pose = poseWithForm(flat.skeleton, flat.motion.poses);
  ASSERT_TRUE(pose);
  EXPECT_TRUE(matchSkeletons(flat.skeleton, flat.skeleton, false, &*pose).twins);
}

}  // namespace
}  // namespace limber
