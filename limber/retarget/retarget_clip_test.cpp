#include "limber/retarget/retarget_clip.h"

#include <gtest/gtest.h>

#include "limber/matching/testing/test_motion.h"
#include "limber/skeleton/motion.h"

namespace limber {
namespace {

TEST(RetargetClip, SamplingGivesBackTheFrames) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = limber::testing::walk(person, 40);
  const Clip clip = clipOf(person, motion, "walk");
  EXPECT_NEAR(frameRateOf(clip), 60, 1e-3);
  const PoseSequence again = sampleFrames(person, clip, 60);
  ASSERT_EQ(again.poses.size(), motion.poses.size());
  for (std::size_t f = 0; f < again.poses.size(); ++f) {
    for (Index j = 0; j < person.jointCount(); ++j) {
      const Transform &a = again.poses[f].locals[j], &b = motion.poses[f].locals[j];
      ASSERT_LT((a.translation - b.translation).norm(), 1e-5);
      ASSERT_GT(std::abs(a.rotation.dot(b.rotation)), 1 - 1e-6);
    }
  }
}

TEST(RetargetClip, StandingStillLastsAsLong) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence still{std::vector<Pose>(31, restPose(person)), 1.0 / 30};
  const Clip clip = clipOf(person, still, "still");
  EXPECT_NEAR(clip.duration(), 1, 1e-6);
  EXPECT_NEAR(frameRateOf(clip), 30, 1e-3);
  checkClip(clip, person);
  const Clip there = retargetClip(findRetargetMethod("limb-ik"), person, clip, limber::testing::scaled(person, 2),
                                  matchSkeletons(person, person), {}, 0);
  EXPECT_NEAR(there.duration(), 1, 1e-6);
}

}  // namespace
}  // namespace limber
