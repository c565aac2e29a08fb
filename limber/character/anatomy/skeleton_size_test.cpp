#include "limber/character/anatomy/skeleton_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/skeleton/motion.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::MadeBody;
using testing::NameHabit;
using testing::warningKinds;

Skeleton scaled(Skeleton skeleton, double factor) {
  for (Joint& joint : skeleton.joints) joint.rest.translation *= factor;
  return skeleton;
}

std::vector<std::string> warningsOf(const Skeleton& skeleton) {
  Warnings warnings;
  warnUnlikelySize(skeleton, {}, warnings);
  return warningKinds(warnings);
}

SkeletonSize sizeOf(const Skeleton& skeleton) {
  return skeletonSize(skeleton, restPose(skeleton), readAnatomy(skeleton));
}

TEST(SkeletonSize, MeasuresAPersonWhicheverWayItLies) {
  const Skeleton person = testing::personWith(NameHabit::kVrm).skeleton;  // toes at 0.025, head at 1.52
  for (const Skeleton& body : {person, testing::turnedAsAWhole(person, testing::turn(Vec3::UnitX(), 90))}) {
    const SkeletonSize size = sizeOf(body);
    EXPECT_NEAR(size.height, 1.495, 1e-6);
    EXPECT_NEAR(size.longestSide, 1.495, 1e-6);
    ASSERT_TRUE(size.hips);
    EXPECT_NEAR(*size.hips, 0.925, 1e-6);
  }
}

TEST(SkeletonSize, PropsDoNotCountAndSkeletonsWithoutABodyDoAsAWhole) {
  Skeleton armed = testing::personWith(NameHabit::kVrm).skeleton;
  testing::addJoint(armed, "weapon", "rightHand", Vec3(0, 3, 0));
  EXPECT_NEAR(sizeOf(armed).height, 1.495, 1e-6);
  Skeleton single;
  testing::addJoint(single, "a", "", Vec3(0, 1, 0));
  EXPECT_EQ(sizeOf(single).height, 0);
  EXPECT_EQ(skeletonSize({}, {}, Anatomy()).longestSide, 0);
}

TEST(SkeletonSize, WarnsOfPeopleAndQuadrupedsInAnotherUnit) {
  for (const Skeleton& body : {testing::personWith(NameHabit::kMixamo).skeleton, testing::dog().skeleton}) {
    EXPECT_THAT(warningsOf(body), ::testing::IsEmpty());
    EXPECT_THAT(warningsOf(scaled(body, 2)), ::testing::IsEmpty());
    for (const double factor : {0.01, 0.0254, 39.37, 100.0}) {
      EXPECT_THAT(warningsOf(scaled(body, factor)), ::testing::ElementsAre("unlikely-size")) << factor;
    }
  }
  Warnings warnings;
  warnUnlikelySize(scaled(testing::personWith(NameHabit::kVrm).skeleton, 0.01), {}, warnings);
  EXPECT_EQ(warnings.items().at(0).message,
            "the body measures 0.0149 m, as hardly any person or quadruped does: is its unit of length another?");
}

TEST(SkeletonSize, DoesNotWarnOfOtherBodies) {
  for (const MadeBody& body : {testing::crow(), testing::snake(), testing::fish(), testing::spider()}) {
    for (const double factor : {0.01, 100.0})
      EXPECT_THAT(warningsOf(scaled(body.skeleton, factor)), ::testing::IsEmpty());
  }
  EXPECT_THAT(warningsOf({}), ::testing::IsEmpty());
}

// Files whose rest pose is in another unit than their frames, or has no form at all, play in the right size.
TEST(SkeletonSize, ASizeThatTheMotionHasIsNone) {
  const Skeleton person = testing::personWith(NameHabit::kMixamo).skeleton;
  Motion motion;
  motion.skeleton = scaled(person, 0.01);
  Clip& clip = motion.clips.emplace_back();
  for (Index j = 0; j < person.jointCount(); ++j) {
    Track<Vec3f>& track = clip.translations.emplace_back();
    track.joint = j;
    track.times = {0};
    track.values = {person.joints[j].rest.translation.cast<float>()};
  }
  Warnings warnings;
  warnUnlikelySize(motion.skeleton, motion.clips, warnings);
  EXPECT_TRUE(warnings.empty());
  for (Track<Vec3f>& track : clip.translations) track.values[0] *= 0.005f;
  warnUnlikelySize(motion.skeleton, motion.clips, warnings);
  EXPECT_THAT(warningKinds(warnings), ::testing::ElementsAre("unlikely-size"));
}

}  // namespace
}  // namespace limber
